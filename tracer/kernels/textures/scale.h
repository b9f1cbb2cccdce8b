// SPDX-License-Identifier: Apache-2.0
// The product of two textures.
#pragma once

#include "tracer/kernels/texture.h"

#define DS_SCALE_INPUTS(INPUT) INPUT(scale_texture1, 3, 1.0f) INPUT(scale_texture2, 3, 1.0f)
#define DS_SCALE_NUMBERS(NUMBER)
enum { DS_SCALE_INPUTS(DS_INPUT_INDEX) scale_inputs };
DS_TRAITS(scale, 0);

DS_FN real3 scale_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs) {
  return mul(inputs[scale_texture1], inputs[scale_texture2]);
}
