// SPDX-License-Identifier: Apache-2.0
// A smooth dielectric boundary: reflects F kr, refracts (1 - F) kt, F being Fresnel's reflectance.
// Radiance changes by the square of the index ratio on the way through (Veach 1997, 5.2), which
// leaving the body undoes.
#pragma once

#include "tracer/kernels/microfacet.h"

#define DS_GLASS_INPUTS(INPUT)      \
  INPUT(glass_kr, 3, 1.0f)          \
  INPUT(glass_kt, 3, 1.0f)          \
  INPUT(glass_interiorior, 1, 1.5f) \
  INPUT(glass_exteriorior, 1, 1.0f)
#define DS_GLASS_NUMBERS(NUMBER)
enum { DS_GLASS_INPUTS(DS_SLOT) DS_GLASS_NUMBERS(DS_NUMBER_SLOT) glass_end, glass_derived = 0 };
enum { glass_children = 0 };
DS_TRAITS(glass, k_trait_lobes | k_trait_casts_caustics);
#ifdef DS_HOOK_HOST
inline constexpr Parameter glass_parameters[] = {
    {"kr", "factor on what is reflected", k_not_negative, ParameterKind::share},
    {"kt", "factor on what is let through", k_not_negative, ParameterKind::share},
    {"interiorior", "index of refraction inside, beneath the surface", {.least = 0.01}},
    {"exteriorior", "index of refraction outside", {.least = 0.01}}};
inline constexpr NodeOnHost glass_on_host{
    .parameters = glass_parameters, .most_lost = 0, .albedo_error = 1e-6};
#endif

DS_FN void glass_prepare(const real* p, Viewer viewer, real* derived) {}

DS_FN BsdfValue glass_evaluate(const real* p, Viewer viewer, real3 wi) {
  return no_value();
}

DS_FN BsdfSample glass_sample(const real* p, Viewer viewer, real2 u, real2 lobe) {
  const real3 wo = viewer.wo;
  const real inside_over_outside = p[glass_interiorior] / p[glass_exteriorior];
  const real eta = choose(viewer.outside, inside_over_outside, 1.0f / inside_over_outside);
  real cos_t;
  const real reflectance = dielectric_fresnel(eta, lesser(wo.z, (real)(1.0f)), &cos_t);
  const mask reflects = lobe.x < reflectance;
  BsdfSample s = no_sample();
  const real3 mirrored = vec(-wo.x, -wo.y, wo.z);
  const real3 refracted = unit(vec(-wo.x / eta, -wo.y / eta, -greater(cos_t, (real)(1e-6f))));
  s.wi = choose(reflects, mirrored, refracted);
  // The choice of lobe cancels its Fresnel factor.
  s.eta_scale = choose(reflects, (real)(1.0f), 1.0f / (eta * eta));
  s.weight = choose(reflects, input3(p, glass_kr), scale(input3(p, glass_kt), s.eta_scale));
  s.valid = s.specular = all_lanes();
  return s;
}

#ifdef DS_HOOK_ALBEDO
DS_FN real3 glass_albedo(const real* p, Viewer viewer) {
  real cos_t;
  const real reflectance =
      dielectric_fresnel(p[glass_interiorior] / p[glass_exteriorior], (real)(1.0f), &cos_t);
  return lerp3(input3(p, glass_kt), input3(p, glass_kr), reflectance);
}
#endif

#ifdef DS_HOOK_LIGHT_PLANES
DS_FN real3 glass_diffuse(const real* p, Viewer viewer, real3 wi) {
  return splat((real)(0.0f));
}
#endif
