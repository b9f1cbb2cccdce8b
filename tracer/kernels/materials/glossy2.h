// SPDX-License-Identifier: Apache-2.0
// A matte base kd under a rough dielectric coat of reflectance ks at normal incidence (or of
// refractive index `index` where that is not 0), with absorption ka over depth d in the coat. Without
// `doublesided` the back, which the true normals point away from, has no coat. Where uroughness and
// vroughness differ, u runs along an axis made of the normal; in LuxCore it is the mesh's uv that says.
//
// The coat is GGX with Schlick's Fresnel, and what comes back after several reflections among its
// facets (microfacet.h). What the coat does not reflect lights the base (Kelemen and Szirmay-Kalos
// 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling"):
//   f = D G2 F(h) / (4 cos_o cos_i) + further reflections
//       + kd / pi (1 - C(o)) (1 - C(i)) / (1 - mean C) exp(-ka d (1 / cos_o + 1 / cos_i))
// C(w) being the coat's albedo seen from w. Reciprocal, and over a white base all that comes in
// goes out, at every roughness. LuxCore has the first reflection only and weighs the base by
// 1 - F(h), which gains energy at grazing and loses it in a rough coat.
#pragma once

#include "tracer/kernels/microfacet.h"

#define DS_GLOSSY2_INPUTS(INPUT)     \
  INPUT(glossy2_kd, 3, 0.5f)         \
  INPUT(glossy2_ks, 3, 0.5f)         \
  INPUT(glossy2_uroughness, 1, 0.1f) \
  INPUT(glossy2_vroughness, 1, 0.1f) \
  INPUT(glossy2_ka, 3, 0.0f)         \
  INPUT(glossy2_d, 1, 0.0f)          \
  INPUT(glossy2_index, 1, 0.0f)
#define DS_GLOSSY2_NUMBERS(NUMBER) NUMBER(glossy2_doublesided, 0.0f)
enum { DS_GLOSSY2_INPUTS(DS_SLOT) DS_GLOSSY2_NUMBERS(DS_NUMBER_SLOT) glossy2_end };
enum { glossy2_children = 0 };
DS_TRAITS(glossy2, k_trait_lobes | k_trait_casts_caustics | k_trait_receives_caustics);
#ifdef DS_HOOK_HOST
inline constexpr Parameter glossy2_parameters[] = {
    {"kd", "what the base sends on to all sides", k_not_negative, ParameterKind::share},
    {"ks", "what the coat reflects at normal incidence", k_not_negative, ParameterKind::share},
    {"uroughness", "width of the facets along u: alpha of GGX", k_zero_to_one},
    {"vroughness", "width of the facets along v: alpha of GGX", k_zero_to_one},
    {"ka", "absorption in the coat, 1 over the unit of d", k_not_negative},
    {"d", "depth of the coat", k_not_negative},
    {"index", "refractive index of the coat; ks is not asked then, nor where this is 0",
     k_not_negative},
    {"doublesided", "1: the back has the coat too", {}, ParameterKind::flag}};
inline constexpr NodeOnHost glossy2_on_host{.parameters = glossy2_parameters, .albedo_error = 0.05};
#endif
/// What is derived: the parts of a Coat, then what the coat does to light for the viewer.
enum {
  glossy2_share,
  glossy2_mean,
  glossy2_upright,
  glossy2_at_normal,                             ///< 3
  glossy2_again = glossy2_at_normal + 3,         ///< 3
  glossy2_passed_out = glossy2_again + 3,        ///< 3: 1 - C(o)
  glossy2_passed_mean = glossy2_passed_out + 3,  ///< 3: 1 - mean C
  glossy2_first = glossy2_passed_mean + 3,  ///< probability of sampling the coat's first reflection
  glossy2_derived
};

/// Where the viewer sees the base without a coat.
DS_FN mask glossy2_is_bare(const real* p, Viewer viewer) {
  return !viewer.outside & (p[glossy2_doublesided] == 0.0f);
}

DS_FN real3 glossy2_normal_reflectance(const real* p) {
  const real index = p[glossy2_index];
  const real r = (index - 1.0f) / (index + 1.0f);
  return choose(index > 0.0f, splat(r * r), input3(p, glossy2_ks));
}

/// What is left on the way in and out, at these cosines.
DS_OUT_OF_LINE real3 glossy2_absorption(const real* p, real cos_o, real cos_i) {
  const real path =
      p[glossy2_d] * (1.0f / greater(cos_o, (real)(1e-4f)) + 1.0f / greater(cos_i, (real)(1e-4f)));
  const real3 ka = input3(p, glossy2_ka);
  return vec(exponential(-ka.x * path), exponential(-ka.y * path), exponential(-ka.z * path));
}

/// The coat's facets, its reflectance at normal incidence, and Fresnel's part in what comes back
/// after several reflections.
typedef struct {
  Roughness roughness;
  Rescattering again;
  real3 ks, again_fresnel;
} Coat;

/// Schlick's mean over the cosine-weighted hemisphere: the integral of 2 c (1 - c)^5 is 1/21.
DS_FN real glossy2_again_fresnel(Rescattering again, real ks) {
  return rescattered_fresnel(again, fma(1.0f - ks, (real)(1.0f / 21.0f), ks));
}

/// What the coat leaves of the light when it loses `lost` at first and has Schlick's weight
/// `grazing`.
DS_FN real glossy2_left(real ks, real again_fresnel, real lost, real grazing) {
  return clamp01(1.0f - fma(ks, 1.0f - lost - grazing, grazing) - again_fresnel * lost);
}
DS_FN real3 glossy2_left3(Coat c, real lost, real grazing) {
  return vec(glossy2_left(c.ks.x, c.again_fresnel.x, lost, grazing),
             glossy2_left(c.ks.y, c.again_fresnel.y, lost, grazing),
             glossy2_left(c.ks.z, c.again_fresnel.z, lost, grazing));
}

/// 1 - C, seen from w. Of unequal roughnesses the one that reflects more counts at grazing, so that no
/// azimuth gains.
DS_FN real3 glossy2_passed(Coat c, real3 w) {
  const real grazing =
      greater(ggx_grazing_share(c.roughness.x, w.z), ggx_grazing_share(c.roughness.y, w.z));
  return glossy2_left3(c, rescattered_share(c.again, w), grazing);
}

/// 1 - mean C.
DS_FN real3 glossy2_mean_passed(Coat c) {
  const real grazing =
      lesser(ggx_mean_grazing_share(c.roughness.x), ggx_mean_grazing_share(c.roughness.y));
  return glossy2_left3(c, c.again.share * c.again.mean, grazing);
}

/// Probability of sampling the coat's first reflection: the coat's share of what is reflected, as
/// seen from wo, without what comes back after several reflections. That is sampled as the base is.
DS_FN real glossy2_lobe_probability(const real* p, Coat c, real3 passed, real3 wo) {
  const real through = luminance(passed);
  const real coat = 1.0f - through;
  const real sum = fma(luminance(input3(p, glossy2_kd)), through, coat);
  const real share = choose(
      sum > 0.0f, greater(coat, (real)(1e-10f)) / greater(sum, (real)(1e-10f)), (real)(0.5f));
  return clamp01(share) * (1.0f - rescattered_share(c.again, wo));
}

DS_FN void glossy2_prepare(const real* p, Viewer viewer, real* derived) {
  Coat c;
  c.roughness = roughness_of(p[glossy2_uroughness], p[glossy2_vroughness]);
  c.again = ggx_rescattering(c.roughness);
  c.ks = glossy2_normal_reflectance(p);
  c.again_fresnel =
      vec(glossy2_again_fresnel(c.again, c.ks.x), glossy2_again_fresnel(c.again, c.ks.y),
          glossy2_again_fresnel(c.again, c.ks.z));
  const real3 passed = glossy2_passed(c, viewer.wo);
  derived[glossy2_share] = c.again.share;
  derived[glossy2_mean] = c.again.mean;
  derived[glossy2_upright] = c.again.upright;
  put3(derived, glossy2_at_normal, c.ks);
  put3(derived, glossy2_again, c.again_fresnel);
  put3(derived, glossy2_passed_out, passed);
  put3(derived, glossy2_passed_mean, glossy2_mean_passed(c));
  derived[glossy2_first] = choose(glossy2_is_bare(p, viewer), (real)(0.0f),
                                  glossy2_lobe_probability(p, c, passed, viewer.wo));
}

DS_FN Coat glossy2_coat(const real* p) {
  const real* derived = p + glossy2_end;
  Coat c;
  c.roughness = roughness_of(p[glossy2_uroughness], p[glossy2_vroughness]);
  c.again = ggx_rescattering_of(c.roughness, derived[glossy2_share], derived[glossy2_mean],
                                derived[glossy2_upright]);
  c.ks = input3(derived, glossy2_at_normal);
  c.again_fresnel = input3(derived, glossy2_again);
  return c;
}

/// Base times cosine of wi.
DS_FN real3 glossy2_base(const real* p, Coat c, real3 wo, real3 wi) {
  const real* derived = p + glossy2_end;
  const real3 mean = input3(derived, glossy2_passed_mean);
  const real3 coupled = mul(input3(derived, glossy2_passed_out), glossy2_passed(c, wi));
  // A coat that lets nothing through has nothing under it: 0 / 1e-6.
  const real3 through =
      vec(coupled.x / greater(mean.x, (real)(1e-6f)), coupled.y / greater(mean.y, (real)(1e-6f)),
          coupled.z / greater(mean.z, (real)(1e-6f)));
  const real3 base = scale(mul(input3(p, glossy2_kd), through), wi.z * DS_INV_PI);
  if (!any_lane(p[glossy2_d] > 0.0f)) return base;
  return mul(base, glossy2_absorption(p, wo.z, wi.z));
}

/// All lobes at wi, which is above the surface.
DS_INLINED BsdfValue glossy2_all(const real* p, Viewer viewer, Coat c, real3 wi) {
  const real3 wo = viewer.wo;
  const real3 h = half_vector(wo, wi);
  const Lobe lobe = ggx_lobe(c.roughness, wo, wi, h);
  BsdfValue v;
  v.value =
      add_scaled(glossy2_base(p, c, wo, wi), schlick_fresnel(c.ks, dot(wo, h)), lobe.specular);
  v.value = add_scaled(v.value, c.again_fresnel, rescattered(c.again, wo, wi));
  const real3 bare = scale(input3(p, glossy2_kd), wi.z * DS_INV_PI);
  v.value = choose(glossy2_is_bare(p, viewer), bare, v.value);
  const real first = (p + glossy2_end)[glossy2_first];
  v.pdf = first * lobe.pdf + (1.0f - first) * wi.z * DS_INV_PI;
  return v;
}

DS_FN BsdfValue glossy2_evaluate(const real* p, Viewer viewer, real3 wi) {
  const mask above = wi.z > 0.0f;
  BsdfValue v = glossy2_all(p, viewer, glossy2_coat(p), choose(above, wi, viewer.wo));
  v.value = choose(above, v.value, splat((real)(0.0f)));
  v.pdf = choose(above, v.pdf, (real)(0.0f));
  return v;
}

DS_FN BsdfSample glossy2_sample(const real* p, Viewer viewer, real2 u, real2 lobe) {
  const Coat c = glossy2_coat(p);
  BsdfSample s = no_sample();
  s.glossy = lobe.x < (p + glossy2_end)[glossy2_first];
  const real3 mirrored = reflect_about(viewer.wo, ggx_visible_normal(c.roughness, viewer.wo, u));
  s.wi = choose(s.glossy, mirrored, cosine_hemisphere(u));
  s.valid = s.wi.z > 0.0f;
  const BsdfValue v = glossy2_all(p, viewer, c, choose(s.valid, s.wi, viewer.wo));
  s.pdf = v.pdf;
  s.weight = scale(v.value, 1.0f / greater(v.pdf, (real)(1e-20f)));
  return s;
}

#ifdef DS_HOOK_ALBEDO
DS_FN real3 glossy2_albedo(const real* p, Viewer viewer) {
  const real3 kd = input3(p, glossy2_kd);
  const real3 passed = input3(p + glossy2_end, glossy2_passed_out);
  // Gauss's rule of two nodes for the cosine by which the light leaves.
  const real3 left =
      lerp3(glossy2_absorption(p, viewer.wo.z, (real)(0.355051026f)),
            glossy2_absorption(p, viewer.wo.z, (real)(0.844948974f)), (real)(0.636082763f));
  const real3 coated = add(sub(splat((real)(1.0f)), passed), mul(mul(kd, passed), left));
  return choose(glossy2_is_bare(p, viewer), kd, coated);
}
#endif

#ifdef DS_HOOK_LIGHT_PLANES
DS_FN real3 glossy2_diffuse(const real* p, Viewer viewer, real3 wi) {
  const mask above = wi.z > 0.0f;
  const real3 safe_wi = choose(above, wi, viewer.wo);
  const real3 bare = scale(input3(p, glossy2_kd), safe_wi.z * DS_INV_PI);
  const real3 base = glossy2_base(p, glossy2_coat(p), viewer.wo, safe_wi);
  return choose(above, choose(glossy2_is_bare(p, viewer), bare, base), splat((real)(0.0f)));
}
#endif
