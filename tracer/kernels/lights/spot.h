// SPDX-License-Identifier: Apache-2.0
// A point that shines into a cone.
//
// Full strength within the inner angle, falling to nothing at the outer one with the fourth power of
// the linear ramp in the cosine. Intensity at angle a from the axis is that on the axis over cos a,
// as LuxCore has it (measured: a plane square to the axis is lit by cos^2 a, not cos^3 a), so that
// its files look the same here. Cosines below 1e-3 count as 1e-3.
#pragma once

#include "tracer/kernels/lights/point.h"

enum {
  spot_axis = 6,         ///< 3: unit, the way it shines
  spot_cos_total = 9,    ///< cosine of the outer angle
  spot_cos_falloff = 10  ///< cosine of the inner angle, > cos_total
};
DS_TRAITS(spot, k_trait_sampled | k_trait_small);

#ifdef DS_HOOK_HOST
inline constexpr LightInput spot_inputs[] = {point_inputs[0],
                                             point_inputs[1],
                                             {"direction", LightValue::direction},
                                             {"cos_total", LightValue::number},
                                             {"cos_falloff", LightValue::number}};
inline double spot_power(double luminance, const float* inputs, double scene_radius) {
  const double total = inputs[spot_cos_total], falloff = inputs[spot_cos_falloff];
  return point_power(luminance, inputs, scene_radius) * ((1 - (total + falloff) / 2) / 2);
}
/// Equal angles make a sharp edge: one ulp apart, so that the ramp has a width.
inline void spot_row(const float* inputs, float* row) {
  for (int i = 0; i <= spot_cos_falloff; ++i)
    row[i] = inputs[i];
  row[spot_cos_falloff] =
      std::fmax(row[spot_cos_falloff], std::nextafter(row[spot_cos_total], 2.0f));
}
inline constexpr LightOnHost spot_on_host = {spot_inputs, k_host_reads, spot_power, spot_row};
#endif

DS_FN LightSample spot_sample(LightTables t, uint at, real3 from, real2 u) {
  DS_GLOBAL float* p = t.lights + at;
  LightSample s = point_sample(t, at, from, u);
  const real cosine = -dot(s.wi, uniform3(p + spot_axis));
  const real ramp =
      clamp01((cosine - p[spot_cos_total]) / (p[spot_cos_falloff] - p[spot_cos_total]));
  s.radiance = scale(s.radiance, square(square(ramp)) / greater(cosine, (real)(1e-3f)));
  s.pdf = choose(ramp > 0.0f, s.pdf, (real)(0.0f));
  return s;
}
