// SPDX-License-Identifier: Apache-2.0
// Light from a cone of directions, from very far: soft shadows. As in LuxCore no camera, mirror or
// glass shows the disc it comes from.
//
// So next-event estimation alone finds it, and its samples are weighed against nothing: each stands
// for the whole cone, as a light of one direction.
#pragma once

#include "tracer/kernels/light.h"

enum {
  distant_irradiance = 0,      ///< 3: radiance times the cone's solid angle
  distant_direction = 3,       ///< 3: unit, the way the cone's middle shines
  distant_tangent = 6,         ///< 3: with the next, a frame around the direction
  distant_bitangent = 9,       ///< 3
  distant_one_minus_cos = 12,  ///< of the cone's half angle
};
DS_TRAITS(distant, k_trait_sampled | k_trait_small);

#ifdef DS_HOOK_HOST
inline constexpr LightInput distant_inputs[] = {
    {"color", LightValue::color, "1 1 1", "radiance, times gain"},
    {"direction", LightValue::direction, "0 0 1", "the way its middle shines"},
    {"theta",
     LightValue::number,
     "10",
     "half the cone's angle, degrees",
     {.least = 0, .most = 90, .open_least = true}}};
enum { distant_input_theta = 6 };
/// Keeps the bits of narrow cones; by the kernels' own polynomial: the same on every machine.
inline double distant_cap(const float* inputs) {
  const double sine = double{sin_cos_turns(inputs[distant_input_theta] / 720).sin};
  return 2 * sine * sine;
}
inline double distant_power(double luminance, const float* inputs, double scene_radius) {
  constexpr double pi = std::numbers::pi;
  return luminance * 2 * pi * distant_cap(inputs) * pi * scene_radius * scene_radius;
}
inline void distant_row(const float* inputs, float* row) {
  const Vec3d z{inputs[3], inputs[4], inputs[5]};
  const Vec3d x =
      normalized(cross(std::fabs(inputs[3]) > 0.9f ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, z));
  const Vec3d y = cross(z, x);
  const double cap = distant_cap(inputs);
  for (int i = 0; i < 3; ++i) {
    row[distant_irradiance + i] =
        static_cast<float>(double{inputs[i]} * 2 * std::numbers::pi * cap);
    row[distant_direction + i] = inputs[3 + i];
    row[distant_tangent + i] = static_cast<float>(x[i]);
    row[distant_bitangent + i] = static_cast<float>(y[i]);
  }
  row[distant_one_minus_cos] = static_cast<float>(cap);
}
inline constexpr LightOnHost distant_on_host = {distant_inputs, 0, distant_power, distant_row};
#endif

DS_FN LightSample distant_sample(LightTables t, uint at, real3 from, real2 u) {
  DS_GLOBAL float* p = t.lights + at;
  const real one_minus_cos = u.x * p[distant_one_minus_cos];
  const real sine = safe_sqrt(one_minus_cos * (2.0f - one_minus_cos));
  const SinCos phi = sin_cos_turns(u.y);
  const real3 along = scale(uniform3(p + distant_direction), 1.0f - one_minus_cos);
  LightSample s = no_light();
  s.wi = negate(unit(add_scaled(add_scaled(along, uniform3(p + distant_tangent), sine * phi.cos),
                                uniform3(p + distant_bitangent), sine * phi.sin)));
  s.dirac = !s.dirac;
  s.radiance = uniform3(p + distant_irradiance);
  s.pdf = (real)(1.0f);
  return s;
}
