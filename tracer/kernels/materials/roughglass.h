// SPDX-License-Identifier: Apache-2.0
// A rough dielectric boundary: GGX facets, each of which reflects F kr and refracts (1 - F) kt, F
// being Fresnel's reflectance (Walter et al. 2007, "Microfacet Models for Refraction through Rough
// Surfaces", with 1 / (1 + Lambda(i) + Lambda(o)) for both ways' shadowing in place of a product).
// What would need several facets is lost, as in LuxCore: of diffuse light from outside 2 % at
// roughness 0.2, 6 % at 0.4 and 21 % at 1; from inside, where facets reflect totally, 10, 26 and 58 %.
// Where uroughness and vroughness differ, u runs along an axis made of the normal; in LuxCore it is the
// mesh's uv that says.
//
// Radiance changes by the square of the index ratio on the way through, as in glass. Indices within
// 1 % of each other bend nothing that could be seen: there what is not reflected goes straight on.
#pragma once

#include "tracer/kernels/microfacet.h"

#define DS_ROUGHGLASS_INPUTS(INPUT)      \
  INPUT(roughglass_kr, 3, 1.0f)          \
  INPUT(roughglass_kt, 3, 1.0f)          \
  INPUT(roughglass_interiorior, 1, 1.5f) \
  INPUT(roughglass_exteriorior, 1, 1.0f) \
  INPUT(roughglass_uroughness, 1, 0.1f)  \
  INPUT(roughglass_vroughness, 1, 0.1f)
#define DS_ROUGHGLASS_NUMBERS(NUMBER)
enum { DS_ROUGHGLASS_INPUTS(DS_SLOT) DS_ROUGHGLASS_NUMBERS(DS_NUMBER_SLOT) roughglass_end };
enum { roughglass_derived = 0, roughglass_children = 0 };
DS_TRAITS(roughglass, k_trait_lobes | k_trait_casts_caustics | k_trait_transmits);
#ifdef DS_HOOK_HOST
/// Its facets' alone: where several of them would lose little, and none reflects totally.
inline bool roughglass_albedo_holds(const float* p, bool outside) {
  return outside && p[roughglass_exteriorior] <= p[roughglass_interiorior] &&
         p[roughglass_uroughness] <= 0.1f && p[roughglass_vroughness] <= 0.1f;
}
inline constexpr Parameter roughglass_parameters[] = {
    {"kr", "factor on what is reflected", k_not_negative, ParameterKind::share},
    {"kt", "factor on what is let through", k_not_negative, ParameterKind::share},
    {"interiorior", "index of refraction inside, beneath the surface", {.least = 0.01}},
    {"exteriorior", "index of refraction outside", {.least = 0.01}},
    {"uroughness", "width of the facets along u: alpha of GGX", k_zero_to_one},
    {"vroughness", "width of the facets along v: alpha of GGX", k_zero_to_one}};
inline constexpr NodeOnHost roughglass_on_host{.parameters = roughglass_parameters,
                                               .albedo_error = 0.02,
                                               .albedo_holds = roughglass_albedo_holds};
#endif

DS_FN void roughglass_prepare(const real* p, Viewer viewer, real* derived) {}

/// Index of the far side over that of the viewer's side.
DS_FN real roughglass_eta(const real* p, Viewer viewer) {
  const real inside_over_outside = p[roughglass_interiorior] / p[roughglass_exteriorior];
  return choose(viewer.outside, inside_over_outside, 1.0f / inside_over_outside);
}

DS_FN mask roughglass_bends(real eta) {
  return (eta < 0.99f) | (eta > 1.01f);
}

/// Value and pdf of refracting from wo to wi about the facet h: wo on its front, wi on its back.
DS_FN BsdfValue roughglass_refracted(const real* p, Roughness r, real eta, real3 wo, real3 wi,
                                     real3 h) {
  const real front = dot(wo, h);
  const real back = -dot(wi, h);
  const mask meets = (front > 0.0f) & (back > 0.0f) & (wi.z < 0.0f) & roughglass_bends(eta);
  // 1 - F by the cosines on both sides, of which none is lost at grazing or near total reflection.
  const real across = 1.0f / greater(square(front + eta * back), (real)(1e-30f));
  const real along = 1.0f / greater(square(eta * front + back), (real)(1e-30f));
  const real through = 2.0f * eta * front * back * (across + along);
  const real lo = stretched_length(r, wo);
  const real li = stretched_length(r, wi);
  // Solid angle of h over that of wi, without eta^2 back.
  const real squeezed = through * ggx_distribution(r, h) * front /
                        greater(square(front - eta * back), (real)(1e-30f));
  BsdfValue v = no_value();
  const real value = squeezed * back * 2.0f * -wi.z / (lo * -wi.z + li * wo.z);
  v.value = choose(meets, scale(input3(p, roughglass_kt), value), v.value);
  v.pdf = choose(meets, squeezed * back * square(eta) * 2.0f / (wo.z + lo), v.pdf);
  return v;
}

/// Value and pdf of reflecting about h; wi is above the surface.
DS_FN BsdfValue roughglass_reflected(const real* p, Roughness r, real eta, real3 wo, real3 wi,
                                     real3 h) {
  real cos_t;
  const real reflectance = dielectric_fresnel(eta, clamp01(dot(wo, h)), &cos_t);
  const Lobe lobe = ggx_lobe(r, wo, wi, h);
  BsdfValue v;
  v.value = scale(input3(p, roughglass_kr), reflectance * lobe.specular);
  v.pdf = reflectance * lobe.pdf;
  return v;
}

DS_FN BsdfValue roughglass_evaluate(const real* p, Viewer viewer, real3 wi) {
  const real eta = roughglass_eta(p, viewer);
  const Roughness r = roughness_of(p[roughglass_uroughness], p[roughglass_vroughness]);
  const mask above = wi.z > 0.0f;
  BsdfValue v = no_value();
  if (any_lane(above)) {
    const real3 safe_wi = choose(above, wi, viewer.wo);
    v = roughglass_reflected(p, r, eta, viewer.wo, safe_wi, half_vector(viewer.wo, safe_wi));
  }
  if (any_lane(!above)) {
    const real3 safe_wi = choose(above | !roughglass_bends(eta), negate(viewer.wo), wi);
    const real3 h = unit(add(viewer.wo, scale(safe_wi, eta)));
    const BsdfValue below =
        roughglass_refracted(p, r, eta, viewer.wo, safe_wi, choose(h.z < 0.0f, negate(h), h));
    v.value = choose(above, v.value, below.value);
    v.pdf = choose(above, v.pdf, below.pdf);
  }
  return v;
}

DS_FN BsdfSample roughglass_sample(const real* p, Viewer viewer, real2 u, real2 lobe) {
  const real3 wo = viewer.wo;
  const real eta = roughglass_eta(p, viewer);
  const Roughness r = roughness_of(p[roughglass_uroughness], p[roughglass_vroughness]);
  const real3 h = ggx_visible_normal(r, wo, u);
  const real cosine = clamp01(dot(wo, h));
  real cos_t;
  const mask reflects = lobe.x < dielectric_fresnel(eta, cosine, &cos_t);
  const mask straight = !reflects & !roughglass_bends(eta);
  const real3 mirrored = reflect_about(wo, h);
  const real3 refracted =
      unit(add(scale(wo, -1.0f / eta), scale(h, cosine / eta - greater(cos_t, (real)(1e-6f)))));
  BsdfSample s = no_sample();
  s.wi = choose(reflects, mirrored, choose(straight, negate(wo), refracted));
  s.valid = choose_mask(reflects, s.wi.z > 0.0f, s.wi.z < 0.0f);
  s.specular = straight;
  s.glossy = !straight;
  const real height = absolute(s.wi.z);
  const real lo = stretched_length(r, wo);
  const real shadowed = height * (wo.z + lo) /
                        greater(lo * height + stretched_length(r, s.wi) * wo.z, (real)(1e-20f));
  // The choice of what a facet does cancels Fresnel's factor.
  s.eta_scale = choose(reflects, (real)(1.0f), 1.0f / square(eta));
  s.weight = scale(choose(reflects, input3(p, roughglass_kr), input3(p, roughglass_kt)),
                   choose(straight, s.eta_scale, s.eta_scale * shadowed));
  const real3 safe_wi = choose(s.valid, s.wi, wo);
  s.pdf = choose(reflects, roughglass_reflected(p, r, eta, wo, safe_wi, h).pdf,
                 roughglass_refracted(p, r, eta, wo, s.wi, h).pdf);
  return s;
}

#ifdef DS_HOOK_ALBEDO
DS_FN real3 roughglass_albedo(const real* p, Viewer viewer) {
  // Of its facets; what several of them would lose does not count.
  real cos_t;
  const real reflectance = dielectric_fresnel(roughglass_eta(p, viewer), (real)(1.0f), &cos_t);
  return lerp3(input3(p, roughglass_kt), input3(p, roughglass_kr), reflectance);
}
#endif

#ifdef DS_HOOK_LIGHT_PLANES
DS_FN real3 roughglass_diffuse(const real* p, Viewer viewer, real3 wi) {
  return splat((real)(0.0f));
}
#endif
