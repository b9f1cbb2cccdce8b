// SPDX-License-Identifier: Apache-2.0
// The sun's disc through a clear sky.
//
// A disc at infinity of uniform radiance.
#pragma once

#include "tracer/kernels/light.h"

enum {
  sun_radiance = 0,   ///< 3
  sun_direction = 3,  ///< 3: unit, towards the sun
  sun_tangent = 6,    ///< 3: with the next, a frame around the direction
  sun_bitangent = 9,  ///< 3
  sun_one_minus_cos =
      12,  ///< 1 - cos of the angular radius: kept as such, a cosine near 1 has few bits of it
  sun_sin2 = 13,  ///< squared sine of the angular radius
  sun_pdf = 14    ///< 1 / solid angle
};
DS_TRAITS(sun, k_trait_beyond | k_trait_sampled | k_trait_small);

#ifdef DS_HOOK_HOST
inline constexpr LightInput sun_inputs[] = {{"color", LightValue::color},
                                            {"direction", LightValue::direction},
                                            {"cos_total", LightValue::number}};
enum { sun_input_cos_total = 6 };
inline double sun_solid_angle(const float* inputs) {
  return 2 * std::numbers::pi * (1 - double{inputs[sun_input_cos_total]});
}
/// What falls on a disc of the scene's radius.
inline double sun_power(double luminance, const float* inputs, double scene_radius) {
  return luminance * sun_solid_angle(inputs) * std::numbers::pi * scene_radius * scene_radius;
}
inline void sun_row(const float* inputs, float* row) {
  const Vec3d z{inputs[sun_direction], inputs[sun_direction + 1], inputs[sun_direction + 2]};
  const Vec3d x = normalized(
      cross(std::fabs(inputs[sun_direction]) > 0.9f ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, z));
  const Vec3d y = cross(z, x);
  for (int i = 0; i < sun_tangent; ++i)
    row[i] = inputs[i];
  for (int i = 0; i < 3; ++i) {
    row[sun_tangent + i] = static_cast<float>(x[i]);
    row[sun_bitangent + i] = static_cast<float>(y[i]);
  }
  const double one_minus_cos = 1 - double{inputs[sun_input_cos_total]};
  row[sun_one_minus_cos] = static_cast<float>(one_minus_cos);
  row[sun_sin2] = static_cast<float>(one_minus_cos * (2 - one_minus_cos));
  row[sun_pdf] = static_cast<float>(1 / sun_solid_angle(inputs));
}
inline constexpr LightOnHost sun_on_host = {sun_inputs, k_host_reads, sun_power, sun_row};
#endif

DS_FN LightSample sun_sample(LightTables t, uint at, real3 from, real2 u) {
  DS_GLOBAL float* p = t.lights + at;
  const real one_minus_cos = u.x * p[sun_one_minus_cos];
  const real sine = safe_sqrt(one_minus_cos * (2.0f - one_minus_cos));
  const SinCos phi = sin_cos_turns(u.y);
  LightSample s = no_light();
  const real3 along = scale(uniform3(p + sun_direction), 1.0f - one_minus_cos);
  s.wi = unit(add_scaled(add_scaled(along, uniform3(p + sun_tangent), sine * phi.cos),
                         uniform3(p + sun_bitangent), sine * phi.sin));
  s.radiance = uniform3(p + sun_radiance);
  s.pdf = (real)(p[sun_pdf]);
  return s;
}

DS_FN real3 sun_escape(LightTables t, uint at, real3 direction, real* pdf) {
  DS_GLOBAL float* p = t.lights + at;
  const real x = dot(direction, uniform3(p + sun_tangent));
  const real y = dot(direction, uniform3(p + sun_bitangent));
  const real z = dot(direction, uniform3(p + sun_direction));
  const mask in_disc = (x * x + y * y <= p[sun_sin2]) & (z > 0.0f);
  *pdf = choose(in_disc, (real)(p[sun_pdf]), (real)(0.0f));
  return choose(in_disc, uniform3(p + sun_radiance), splat((real)(0.0f)));
}
