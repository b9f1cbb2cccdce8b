// SPDX-License-Identifier: Apache-2.0
// A perfect mirror of reflectance kr.
#pragma once

#include "tracer/kernels/bsdf.h"

#define DS_MIRROR_INPUTS(INPUT) INPUT(mirror_kr, 3, 1.0f)
#define DS_MIRROR_NUMBERS(NUMBER)
enum { DS_MIRROR_INPUTS(DS_SLOT) DS_MIRROR_NUMBERS(DS_NUMBER_SLOT) mirror_end, mirror_derived = 0 };
enum { mirror_children = 0 };
DS_TRAITS(mirror, k_trait_casts_caustics);
#ifdef DS_HOOK_HOST
inline constexpr Parameter mirror_parameters[] = {
    {"kr", "what is reflected", k_not_negative, ParameterKind::share}};
inline constexpr NodeOnHost mirror_on_host{
    .parameters = mirror_parameters, .most_lost = 0, .albedo_error = 1e-6};
#endif

DS_FN void mirror_prepare(const real* p, Viewer viewer, real* derived) {}

DS_FN BsdfValue mirror_evaluate(const real* p, Viewer viewer, real3 wi) {
  return no_value();
}

DS_FN BsdfSample mirror_sample(const real* p, Viewer viewer, real2 u, real2 lobe) {
  BsdfSample s = no_sample();
  s.wi = vec(-viewer.wo.x, -viewer.wo.y, viewer.wo.z);
  s.weight = input3(p, mirror_kr);
  s.valid = s.specular = all_lanes();
  return s;
}

#ifdef DS_HOOK_ALBEDO
DS_FN real3 mirror_albedo(const real* p, Viewer viewer) {
  return input3(p, mirror_kr);
}
#endif

#ifdef DS_HOOK_LIGHT_PLANES
DS_FN real3 mirror_diffuse(const real* p, Viewer viewer, real3 wi) {
  return splat((real)(0.0f));
}
#endif
