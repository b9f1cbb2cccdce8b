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

DS_FN real3 fbm_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs) {
  return splat(
      fractal_noise(at.position, (real)(numbers[fbm_roughness]), (int)numbers[fbm_octaves]));
}
