// SPDX-License-Identifier: Apache-2.0
// Parallel light of one direction, from very far. As in LuxCore no camera, mirror or glass shows where
// it comes from.
#pragma once

#include "tracer/kernels/light.h"

enum {
  sharpdistant_irradiance = 0,  ///< 3: of a surface square to it
  sharpdistant_direction = 3,   ///< 3: unit, the way it shines
};
DS_TRAITS(sharpdistant, k_trait_sampled | k_trait_small);

#ifdef DS_HOOK_HOST
inline constexpr LightInput sharpdistant_inputs[] = {
    {"color", LightValue::color, "1 1 1", "irradiance of what is square to it, times gain"},
    {"direction", LightValue::direction, "0 0 1", "the way it shines"}};
/// What falls on a disc of the scene's radius.
inline double sharpdistant_power(double luminance, const float* inputs, double scene_radius) {
  return luminance * std::numbers::pi * scene_radius * scene_radius;
}
inline constexpr LightOnHost sharpdistant_on_host = {sharpdistant_inputs, 0, sharpdistant_power};
#endif

DS_FN LightSample sharpdistant_sample(LightTables t, uint at, real3 from, real2 u) {
  DS_GLOBAL float* p = t.lights + at;
  LightSample s = no_light();
  s.wi = negate(uniform3(p + sharpdistant_direction));
  s.dirac = !s.dirac;
  s.radiance = uniform3(p + sharpdistant_irradiance);
  s.pdf = (real)(1.0f);
  return s;
}
