// SPDX-License-Identifier: Apache-2.0
// A rough conductor: GGX microfacets with the exact Fresnel reflectance of n + ik for each of r, g,
// b, and the light that comes back after several reflections among them, so that a rough metal is
// no darker than a smooth one. LuxCore has the first reflection only (and loses up to 0.78 of the
// energy). Where uroughness and vroughness differ, u runs along an axis made of the normal; in LuxCore
// it is the mesh's uv that says.
#pragma once

#include "tracer/kernels/microfacet.h"

#define DS_METAL2_INPUTS(INPUT)     \
  INPUT(metal2_n, 3, 0.5f)          \
  INPUT(metal2_k, 3, 0.5f)          \
  INPUT(metal2_uroughness, 1, 0.1f) \
  INPUT(metal2_vroughness, 1, 0.1f)
#define DS_METAL2_NUMBERS(NUMBER)
enum { DS_METAL2_INPUTS(DS_SLOT) DS_METAL2_NUMBERS(DS_NUMBER_SLOT) metal2_end };
enum { metal2_children = 0 };
DS_TRAITS(metal2, k_trait_lobes | k_trait_casts_caustics);
#ifdef DS_HOOK_HOST
/// Where n is below 1 and little is absorbed, total reflection sets in at an angle that two facets
/// do not find.
inline bool metal2_albedo_holds(const float* p, bool outside) {
  return p[metal2_k] >= 1 && p[metal2_k + 1] >= 1 && p[metal2_k + 2] >= 1;
}
inline constexpr Parameter metal2_parameters[] = {
    {"n", "index of refraction", k_not_negative},
    {"k", "absorption: imaginary part of the index", k_not_negative},
    {"uroughness", "width of the facets along u: alpha of GGX", k_zero_to_one},
    {"vroughness", "width of the facets along v: alpha of GGX", k_zero_to_one}};
inline constexpr NodeOnHost metal2_on_host{
    .parameters = metal2_parameters, .albedo_error = 0.05, .albedo_holds = metal2_albedo_holds};
#endif
/// What is derived; see Rescattering.
enum {
  metal2_share,
  metal2_mean,
  metal2_upright,
  metal2_again_fresnel,  ///< 3: Fresnel's part in what comes back after several reflections
  metal2_again = metal2_again_fresnel + 3,  ///< probability of sampling that
  metal2_derived
};

DS_FN real3 metal2_fresnel(const real* p, real cosine) {
  const real c = clamp01(cosine);
  return vec(conductor_fresnel(p[metal2_n], p[metal2_k], c),
             conductor_fresnel(p[metal2_n + 1], p[metal2_k + 1], c),
             conductor_fresnel(p[metal2_n + 2], p[metal2_k + 2], c));
}

/// Cosine-weighted mean of the Fresnel reflectance: Gauss's rule of two nodes for the weight 2 c.
DS_FN real3 metal2_average_fresnel(const real* p) {
  return lerp3(metal2_fresnel(p, (real)(0.355051026f)), metal2_fresnel(p, (real)(0.844948974f)),
               (real)(0.636082763f));
}

DS_FN void metal2_prepare(const real* p, Viewer viewer, real* derived) {
  const Rescattering m = ggx_rescattering(roughness_of(p[metal2_uroughness], p[metal2_vroughness]));
  derived[metal2_share] = m.share;
  derived[metal2_mean] = m.mean;
  derived[metal2_upright] = m.upright;
  put3(derived, metal2_again_fresnel, splat((real)(0.0f)));
  derived[metal2_again] = (real)(0.0f);
  if (!any_lane(m.share > 0.0f)) return;
  const real3 average = metal2_average_fresnel(p);
  put3(derived, metal2_again_fresnel,
       vec(rescattered_fresnel(m, average.x), rescattered_fresnel(m, average.y),
           rescattered_fresnel(m, average.z)));
  derived[metal2_again] = rescattered_share(m, viewer.wo);
}

/// Both lobes at wi, which is above the surface; h is their half vector.
DS_INLINED BsdfValue metal2_both(const real* p, real3 wo, real3 wi, real3 h) {
  const real* derived = p + metal2_end;
  const Roughness r = roughness_of(p[metal2_uroughness], p[metal2_vroughness]);
  const Lobe lobe = ggx_lobe(r, wo, wi, h);
  BsdfValue v;
  v.value = scale(metal2_fresnel(p, dot(wo, h)), lobe.specular);
  v.pdf = lobe.pdf;
  const Rescattering m =
      ggx_rescattering_of(r, derived[metal2_share], derived[metal2_mean], derived[metal2_upright]);
  if (!any_lane(m.share > 0.0f)) return v;
  v.value = add_scaled(v.value, input3(derived, metal2_again_fresnel), rescattered(m, wo, wi));
  const real again = derived[metal2_again];
  v.pdf = (1.0f - again) * lobe.pdf + again * wi.z * DS_INV_PI;
  return v;
}

DS_FN BsdfValue metal2_evaluate(const real* p, Viewer viewer, real3 wi) {
  const mask above = wi.z > 0.0f;
  const real3 safe_wi = choose(above, wi, viewer.wo);
  BsdfValue v = metal2_both(p, viewer.wo, safe_wi, half_vector(viewer.wo, safe_wi));
  v.value = choose(above, v.value, splat((real)(0.0f)));
  v.pdf = choose(above, v.pdf, (real)(0.0f));
  return v;
}

DS_FN BsdfSample metal2_sample(const real* p, Viewer viewer, real2 u, real2 lobe) {
  const Roughness r = roughness_of(p[metal2_uroughness], p[metal2_vroughness]);
  const mask again = lobe.x < (p + metal2_end)[metal2_again];
  const real3 normal = ggx_visible_normal(r, viewer.wo, u);
  BsdfSample s = no_sample();
  s.wi = choose(again, cosine_hemisphere(u), reflect_about(viewer.wo, normal));
  s.valid = s.wi.z > 0.0f;
  const real3 safe_wi = choose(s.valid, s.wi, viewer.wo);
  const real3 h = choose(again, half_vector(viewer.wo, safe_wi), normal);
  const BsdfValue v = metal2_both(p, viewer.wo, safe_wi, h);
  s.weight = scale(v.value, 1.0f / v.pdf);
  s.pdf = v.pdf;
  s.glossy = all_lanes();
  return s;
}

#ifdef DS_HOOK_ALBEDO
/// Cosine of a facet's angle to light along the normal, `u` being spread as its facets are: those above
/// 1 / (1 + alpha^2) send it down.
DS_FN real metal2_facet_cosine(real alpha2, real u) {
  return 1.0f / sqrt(fma(alpha2, u / (1.0f - u), (real)(1.0f)));
}

DS_FN real3 metal2_albedo(const real* p, Viewer viewer) {
  const Roughness r = roughness_of(p[metal2_uroughness], p[metal2_vroughness]);
  const real alpha2 = r.x * r.y;
  const real most = 1.0f / (1.0f + alpha2);
  // Gauss's rule of two nodes over the facets that send it up.
  const real3 once =
      lerp3(metal2_fresnel(p, metal2_facet_cosine(alpha2, 0.211324865f * most)),
            metal2_fresnel(p, metal2_facet_cosine(alpha2, 0.788675135f * most)), (real)(0.5f));
  const real again = (p + metal2_end)[metal2_again];
  return add_scaled(scale(once, 1.0f - again), input3(p + metal2_end, metal2_again_fresnel), again);
}
#endif

#ifdef DS_HOOK_LIGHT_PLANES
DS_FN real3 metal2_diffuse(const real* p, Viewer viewer, real3 wi) {
  return splat((real)(0.0f));
}
#endif
