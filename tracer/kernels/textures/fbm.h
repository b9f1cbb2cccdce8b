// SPDX-License-Identifier: Apache-2.0
// Fractal Brownian motion, a sum of octaves of gradient noise; about [-1, 1] at roughness 0.5, mean
// 0.
#pragma once

#include "tracer/kernels/noise.h"
#include "tracer/kernels/texture.h"

#define DS_FBM_INPUTS(INPUT)
#define DS_FBM_NUMBERS(NUMBER) NUMBER(fbm_octaves, 8.0f) NUMBER(fbm_roughness, 0.5f)
enum { DS_FBM_NUMBERS(DS_NUMBER_INDEX) fbm_numbers };
enum { fbm_inputs = 0 };
DS_TRAITS(fbm, k_trait_position);
#ifdef DS_HOOK_HOST
inline MaybeBounds fbm_bounds(std::span<const MaybeBounds> inputs, const float* numbers) {
  return octave_bounds(k_noise_size, -1, numbers[fbm_octaves], numbers[fbm_roughness]);
}
inline constexpr Parameter fbm_parameters[] = {
    {"octaves", "of noise, each finer by 1.99", {.least = 0, .most = 32}, ParameterKind::whole},
    {"roughness", "weight of each octave, of the one before", {.least = -10, .most = 10}}};
inline constexpr NodeOnHost fbm_on_host{.parameters = fbm_parameters, .bounds = fbm_bounds};
#endif

DS_FN real3 fbm_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs) {
  return splat(
      fractal_noise(at.position, (real)(numbers[fbm_roughness]), (int)numbers[fbm_octaves]));
}
