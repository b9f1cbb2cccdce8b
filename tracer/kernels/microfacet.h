// SPDX-License-Identifier: Apache-2.0
// GGX microfacets (Walter et al. 2007; anisotropic and height-correlated after Heitz 2014) and
// Fresnel reflectances. Roughness here is the distribution's alpha. LuxCore's Schlick distribution
// of roughness r = u v is GGX with alpha^2 = r.
#pragma once

#include "tracer/kernels/bsdf.h"

/// Below this alpha a half vector's float32 rounding is as wide as the lobe: roughness is raised to
/// it.
#define k_least_alpha 1e-3f

typedef struct {
  real x, y;  ///< alpha along the tangent and the bitangent, in [k_least_alpha, 1]
} Roughness;

DS_FN Roughness roughness_of(real u, real v) {
  Roughness r;
  r.x = lesser(greater(u, (real)(k_least_alpha)), (real)(1.0f));
  r.y = lesser(greater(v, (real)(k_least_alpha)), (real)(1.0f));
  return r;
}

/// Length of w stretched by alpha: z (1 + 2 Lambda(w)), Heitz 2014, eq. 72 and 86.
DS_FN real stretched_length(Roughness r, real3 w) {
  return sqrt(square(r.x * w.x) + square(r.y * w.y) + square(w.z));
}

/// Distribution of normals D(h), 1/sr.
DS_FN real ggx_distribution(Roughness r, real3 h) {
  const real stretched = square(h.x / r.x) + square(h.y / r.y) + square(h.z);
  return 1.0f / (DS_PI * r.x * r.y * square(stretched));
}

typedef struct {
  real specular;  ///< D G2 / (4 cos_o cos_i) cos_i: the lobe times cosine, before Fresnel
  real pdf;       ///< of reflecting about a visible normal
} Lobe;

DS_FN Lobe ggx_lobe(Roughness r, real3 wo, real3 wi, real3 h) {
  const real d = ggx_distribution(r, h);
  const real lo = stretched_length(r, wo);
  const real li = stretched_length(r, wi);
  Lobe lobe;
  lobe.specular = d * wi.z * 0.5f / (wo.z * li + wi.z * lo);
  lobe.pdf = d * 0.5f / (wo.z + lo);
  return lobe;
}

/// A normal visible from wo. Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical
/// Caps", listing 3.
DS_FN real3 ggx_visible_normal(Roughness r, real3 wo, real2 u) {
  const real3 stretched = unit(vec(r.x * wo.x, r.y * wo.y, wo.z));
  const SinCos phi = sin_cos_turns(u.x);
  const real z = fma(1.0f - u.y, 1.0f + stretched.z, -stretched.z);
  const real sine = safe_sqrt(1.0f - z * z);
  const real3 cap = vec(sine * phi.cos, sine * phi.sin, z);
  const real3 h = add(cap, stretched);
  return unit(vec(r.x * h.x, r.y * h.y, greater(h.z, (real)(1e-7f))));
}

DS_FN real3 half_vector(real3 wo, real3 wi) {
  return unit(add(wo, wi));
}

/// wo mirrored about h.
DS_FN real3 reflect_about(real3 wo, real3 h) {
  return sub(scale(h, 2.0f * dot(wo, h)), wo);
}

/// Schlick 1994: reflectance at normal incidence to white at grazing.
DS_FN real3 schlick_fresnel(real3 at_normal, real cosine) {
  const real w = power5(clamp01(1.0f - cosine));
  return lerp3(at_normal, splat((real)(1.0f)), w);
}

/// Reflectance of a conductor of complex index n + ik in vacuum, unpolarised (Born and Wolf, 14.2;
/// the form of Lagarde 2013). cosine in [0, 1]; n >= 0, k >= 0.
DS_FN real conductor_fresnel(real n, real k, real cosine) {
  const real cos2 = cosine * cosine;
  const real sin2 = 1.0f - cos2;
  const real n2 = n * n;
  const real k2 = k * k;
  const real t0 = n2 - k2 - sin2;
  const real a2_b2 = sqrt(t0 * t0 + 4.0f * n2 * k2);
  const real a = safe_sqrt(0.5f * (a2_b2 + t0));
  const real t1 = a2_b2 + cos2;
  const real t2 = 2.0f * cosine * a;
  const real rs = (t1 - t2) / greater(t1 + t2, (real)(1e-20f));
  const real t3 = cos2 * a2_b2 + sin2 * sin2;
  const real t4 = t2 * sin2;
  const real rp = rs * (t3 - t4) / greater(t3 + t4, (real)(1e-20f));
  return clamp01(0.5f * (rs + rp));
}

/// Reflectance of a smooth dielectric, unpolarised. `eta`: index of the far side over the near
/// side's. cosine in [0, 1].
/// `*cos_t`: cosine of the refracted direction, 0 at total reflection (where the result is 1).
DS_FN real dielectric_fresnel(real eta, real cosine, real* cos_t) {
  const real sin2_t = (1.0f - cosine * cosine) / (eta * eta);
  const mask total = sin2_t >= 1.0f;
  const real ct = safe_sqrt(1.0f - sin2_t);
  *cos_t = choose(total, (real)(0.0f), ct);
  const real parallel = (eta * cosine - ct) / (eta * cosine + ct);
  const real perpendicular = (cosine - eta * ct) / (cosine + eta * ct);
  return choose(total, (real)(1.0f), clamp01(0.5f * (square(parallel) + square(perpendicular))));
}
