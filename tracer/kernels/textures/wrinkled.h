// SPDX-License-Identifier: Apache-2.0
// Turbulence (Perlin 1985): the sum of octaves of the size of gradient noise, octave o of frequency
// 1.99^o and weight roughness^o; at least 0, with creases where the noise is 0.
#pragma once

#include "tracer/kernels/noise.h"
#include "tracer/kernels/texture.h"

#define DS_WRINKLED_INPUTS(INPUT)
#define DS_WRINKLED_NUMBERS(NUMBER) NUMBER(wrinkled_octaves, 8.0f) NUMBER(wrinkled_roughness, 0.5f)
enum { DS_WRINKLED_NUMBERS(DS_NUMBER_INDEX) wrinkled_numbers };
enum { wrinkled_inputs = 0 };
DS_TRAITS(wrinkled, k_trait_position);
#ifdef DS_HOOK_HOST
inline MaybeBounds wrinkled_bounds(std::span<const MaybeBounds> inputs, const float* numbers) {
  return octave_bounds(k_noise_size, 0, numbers[wrinkled_octaves], numbers[wrinkled_roughness]);
}
inline constexpr Parameter wrinkled_parameters[] = {
    {"octaves", "of noise, each finer by 1.99", {.least = 0, .most = 32}, ParameterKind::whole},
    {"roughness", "weight of each octave, of the one before", {.least = -10, .most = 10}}};
inline constexpr NodeOnHost wrinkled_on_host{.parameters = wrinkled_parameters,
                                             .bounds = wrinkled_bounds};
#endif

DS_FN real3 wrinkled_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs) {
  real3 p = at.position;
  real sum = (real)(0.0f);
  real weight = (real)(1.0f);
  for (int o = 0; o < (int)numbers[wrinkled_octaves]; ++o) {
    sum = fma(weight, absolute(gradient_noise(p)), sum);
    p = scale(p, (real)(1.99f));
    weight = weight * (real)(numbers[wrinkled_roughness]);
  }
  return splat(sum);
}
