// SPDX-License-Identifier: Apache-2.0
// Lambert's law on both sides: f = kd / pi.
#pragma once

#include "tracer/kernels/bsdf.h"

#define DS_MATTE_INPUTS(INPUT) INPUT(matte_kd, 3, 0.75f)
#define DS_MATTE_NUMBERS(NUMBER)
enum { DS_MATTE_INPUTS(DS_SLOT) DS_MATTE_NUMBERS(DS_NUMBER_SLOT) matte_end, matte_derived = 0 };
enum { matte_children = 0 };
DS_TRAITS(matte, k_trait_receives_caustics);
#ifdef DS_HOOK_HOST
inline constexpr Parameter matte_parameters[] = {
    {"kd", "what is sent on to all sides", k_not_negative, ParameterKind::share}};
inline constexpr NodeOnHost matte_on_host{
    .parameters = matte_parameters, .most_lost = 0, .albedo_error = 1e-6};
#endif

DS_FN void matte_prepare(const real* p, Viewer viewer, real* derived) {}

DS_FN BsdfValue matte_evaluate(const real* p, Viewer viewer, real3 wi) {
  BsdfValue v;
  const real cosine = greater(wi.z, (real)(0.0f));
  v.value = scale(input3(p, matte_kd), cosine * DS_INV_PI);
  v.pdf = cosine * DS_INV_PI;
  return v;
}

DS_FN BsdfSample matte_sample(const real* p, Viewer viewer, real2 u, real2 lobe) {
  BsdfSample s = no_sample();
  s.wi = cosine_hemisphere(u);
  s.weight = input3(p, matte_kd);
  s.pdf = s.wi.z * DS_INV_PI;
  s.valid = all_lanes();
  return s;
}

#ifdef DS_HOOK_ALBEDO
DS_FN real3 matte_albedo(const real* p, Viewer viewer) {
  return input3(p, matte_kd);
}
#endif

#ifdef DS_HOOK_LIGHT_PLANES
DS_FN real3 matte_diffuse(const real* p, Viewer viewer, real3 wi) {
  return matte_evaluate(p, viewer, wi).value;
}
#endif
