// SPDX-License-Identifier: Apache-2.0
// The same light from everywhere.
//
// Never sampled (its selection probability is 0): directions chosen by the BSDF find it as well as
// any could, and cost no shadow ray.
#pragma once

#include "tracer/kernels/light.h"

#ifdef DS_HOOK_HOST
inline constexpr LightInput constant_infinite_inputs[] = {
    {"color", LightValue::color, "1 1 1", "colour, times gain"}};
inline constexpr LightOnHost constant_infinite_on_host = {constant_infinite_inputs};
#endif

enum { constant_infinite_radiance = 0 /* 3 */ };
DS_TRAITS(constant_infinite, k_trait_beyond);

DS_FN LightSample constant_infinite_sample(LightTables t, uint at, real3 from, real2 u) {
  return no_light();
}

DS_FN real3 constant_infinite_escape(LightTables t, uint at, real3 direction, real* pdf) {
  *pdf = (real)(0.0f);
  return uniform3(t.lights + at + constant_infinite_radiance);
}
