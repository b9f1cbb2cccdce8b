// SPDX-License-Identifier: Apache-2.0
// A point that shines alike to all sides.
#pragma once

#include "tracer/kernels/light.h"

#ifdef DS_HOOK_HOST
inline constexpr LightInput point_inputs[] = {
    {"color", LightValue::color, "1 1 1", "colour, times gain"},
    {"position", LightValue::point, "0 0 0", "metres"}};
inline double point_power(double luminance, const float* inputs, double scene_radius) {
  return 4 * std::numbers::pi * luminance;
}
inline constexpr LightOnHost point_on_host = {point_inputs, k_host_reads, point_power};
#endif

enum { point_intensity = 0 /* 3: W/sr */, point_position = 3 /* 3: metres */ };
DS_TRAITS(point, k_trait_sampled | k_trait_small);

/// Inverse square law. Closer than 1e-10 m the distance counts as 1e-10 m.
DS_FN LightSample point_sample(LightTables t, uint at, real3 from, real2 u) {
  DS_GLOBAL float* p = t.lights + at;
  LightSample s = no_light();
  s.target = uniform3(p + point_position);
  const real3 way = sub(s.target, from);
  const real squared = greater(dot(way, way), (real)(1e-20f));
  s.wi = scale(way, 1.0f / sqrt(squared));
  s.bounded = s.dirac = squared > 0.0f;
  s.radiance = scale(uniform3(p + point_intensity), 1.0f / squared);
  s.pdf = (real)(1.0f);
  return s;
}
