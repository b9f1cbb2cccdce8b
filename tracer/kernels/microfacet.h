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

/// Share of a white lobe's light that one reflection loses: what is masked, or sent below the
/// horizon, by other facets. 1 - E(cosine, alpha), E being the albedo of the lobe above for equal
/// roughnesses and Fresnel 1. A fit of our own to the integral by quadrature: never above it, and
/// below it by at most 0.011 for alpha >= 0.15 (0.06 at grazing for less), which
/// tests/hard/multiple_scattering_test.cc holds. alpha in [0.05, 1], cosine in [0, 1].
DS_FN real ggx_lost(real alpha, real cosine) {
  const real a = alpha;
  const real c = cosine;
  const real p0 = fma(a, fma(a, (real)(4.5545f), (real)(3.4218f)), (real)(1.2378f));
  const real p1 = fma(a, fma(a, (real)(-15.7263f), (real)(20.0f)), (real)(-2.0481f));
  const real p2 = fma(a, fma(a, (real)(2.953f), (real)(-6.0523f)), (real)(-0.7026f));
  const real q0 = fma(a, fma(a, (real)(2.8263f), (real)(-0.5273f)), (real)(0.0463f));
  const real q1 = fma(a, fma(a, (real)(20.0f), (real)(-3.5264f)), (real)(0.0727f));
  const real q2 = fma(a, fma(a, (real)(-16.8357f), (real)(8.9821f)), (real)(0.1451f));
  const real above = a * a * c * fma(c, fma(c, p2, p1), p0);
  return greater(above, (real)(0.0f)) / fma(c, fma(c, q2, q1), q0);
}

/// Multiple scattering among facets (Kulla and Conty 2017, "Revisiting Physically Based Shading at
/// Imageworks"): what one reflection loses on the way in and on the way out comes back as
///   f = (1 - E(o)) (1 - E(i)) / (pi L),  L = mean of 1 - E over the cosine-weighted hemisphere
/// which is reciprocal and makes a white lobe reflect all there is.
typedef struct {
  real alpha;    ///< root mean square of the two
  real share;    ///< of the lost light that comes back: less than 1 for alphas that differ
  real mean;     ///< L
  real upright;  ///< ggx_lost at cosine 1
  real tilt;     ///< (y^2 - x^2) / (x^2 + y^2) of alphas x and y
} Rescattering;

/// What of it is made anew at little cost, so that materials need not keep it: alpha and tilt.
DS_FN Rescattering ggx_rescattering_of(Roughness r, real share, real mean, real upright) {
  const real x2 = square(r.x);
  const real y2 = square(r.y);
  Rescattering m;
  m.alpha = greater(sqrt(0.5f * (x2 + y2)), (real)(0.05f));
  m.tilt = (y2 - x2) / (x2 + y2);
  m.share = share;
  m.mean = mean;
  m.upright = upright;
  return m;
}

/// Below alpha 0.05 nothing comes back (what is lost there is below 0.006 but for grazing), from
/// 0.1 on all.
DS_FN Rescattering ggx_rescattering(Roughness r) {
  const real zero = (real)(0.0f);
  Rescattering m = ggx_rescattering_of(r, zero, zero, zero);
  m.share = clamp01((m.alpha - 0.05f) * 20.0f) * fma(square(m.tilt), (real)(-0.075f), (real)(1.0f));
  m.upright = ggx_lost(m.alpha, (real)(1.0f));
  // A fit to the mean of ggx_lost: never below it, above it by at most 0.0035. Unequal alphas lose less.
  const real a = m.alpha;
  m.mean = a *
           fma(a,
               fma(a, fma(a, fma(a, (real)(-1.65085f), (real)(4.87503f)), (real)(-5.67202f)),
                   (real)(3.04705f)),
               (real)(-0.01554f)) *
           fma(square(m.tilt), (real)(-0.03f), (real)(1.0f));
  return m;
}

/// What one reflection loses of the light from w, unit, above the surface, but for `share`. Between the
/// axes of unequal alphas it is what their root mean square loses. Seen along the smoother one's axis it
/// is no less than upright, along the rougher one's less by up to 0.38 at grazing: bounds of our own below
/// the integral by quadrature, so that no direction gains; at most 0.002 above it, and below it by 0.015
/// to 0.025 in the mean over the hemisphere (alphas 0.05 to 1).
DS_FN real rescattered_loss(Rescattering m, real3 w) {
  const real cosine = lesser(w.z, (real)(1.0f));
  const real x2 = square(w.x);
  const real y2 = square(w.y);
  const real across = m.tilt * (x2 - y2) / greater(x2 + y2, (real)(1e-12f));
  const real between = ggx_lost(m.alpha, cosine);
  const real lost = fma(clamp01(across), lesser(m.upright - between, (real)(0.0f)), between);
  return lost * fma(clamp01(-across), -0.38f * (1.0f - cosine), (real)(1.0f));
}

/// Share of the light from w that comes back after several reflections, for Fresnel 1: also how often
/// that lobe is to be sampled.
DS_FN real rescattered_share(Rescattering m, real3 w) {
  return m.share * rescattered_loss(m, w);
}

/// The lobe of several reflections times the cosine of wi, before Fresnel.
DS_FN real rescattered(Rescattering m, real3 wo, real3 wi) {
  return rescattered_share(m, wo) * rescattered_loss(m, wi) * wi.z * DS_INV_PI / m.mean;
}

/// Fresnel's part in it: a geometric series of reflections of mean reflectance `average` (cosine
/// weighted), of which the share L goes on each time.
DS_FN real rescattered_fresnel(Rescattering m, real average) {
  return average * average * (1.0f - m.mean) / (1.0f - average * m.mean);
}

/// Mean of Schlick's weight (1 - cos_h)^5 over one reflection off a white lobe: with E it gives the
/// albedo under Schlick's Fresnel, ks E + (1 - ks) B. A fit of our own to the integral by
/// quadrature, as the fifth power of a cosine: never below it, above it by at most 0.0075 (where
/// both alpha and cosine are below 0.15, 0.075). alpha in [k_least_alpha, 1], cosine in [0, 1].
DS_FN real ggx_grazing_share(real alpha, real cosine) {
  const real a = alpha;
  const real c = lesser(cosine, (real)(1.0f));
  const real p0 = fma(a, fma(a, (real)(10.5783f), (real)(0.2441f)), (real)(0.0003f));
  const real p1 = fma(a, fma(a, (real)(-0.0261f), (real)(4.114f)), (real)(-0.0067f));
  const real p2 = fma(a, fma(a, (real)(-12.1376f), (real)(-4.7624f)), (real)(2.0276f));
  const real q0 = fma(a, fma(a, (real)(17.9649f), (real)(5.6681f)), (real)(0.0427f));
  const real q1 = fma(a, fma(a, (real)(-10.7474f), (real)(-5.4798f)), (real)(1.6595f));
  const real q2 = fma(a, fma(a, (real)(-9.1967f), (real)(-0.5608f)), (real)(0.6996f));
  return power5(clamp01(1.0f - fma(c, fma(c, p2, p1), p0) / fma(c, fma(c, q2, q1), q0)));
}

/// Cosine-weighted mean of ggx_grazing_share: never above it, below it by at most 0.0025.
DS_FN real ggx_mean_grazing_share(real alpha) {
  const real a = alpha;
  return fma(a, fma(a, fma(a, (real)(-0.10462f), (real)(0.23672f)), (real)(-0.17931f)),
             (real)(0.05103f));
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
