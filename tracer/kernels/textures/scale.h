// SPDX-License-Identifier: Apache-2.0
// The product of two textures.
#pragma once

#include "tracer/kernels/texture.h"

#define DS_SCALE_INPUTS(INPUT) INPUT(scale_texture1, 3, 1.0f) INPUT(scale_texture2, 3, 1.0f)
#define DS_SCALE_NUMBERS(NUMBER)
enum { DS_SCALE_INPUTS(DS_INPUT_INDEX) scale_inputs };
DS_TRAITS(scale, 0);
#ifdef DS_HOOK_HOST
inline MaybeBounds scale_bounds(std::span<const MaybeBounds> inputs, const float* numbers) {
  return combined_bounds(inputs[scale_texture1], inputs[scale_texture2], std::multiplies());
}
inline constexpr Parameter scale_parameters[] = {{"texture1", "a factor"},
                                                 {"texture2", "a factor"}};
inline constexpr NodeOnHost scale_on_host{.parameters = scale_parameters, .bounds = scale_bounds};
#endif

DS_FN real3 scale_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs) {
  return mul(inputs[scale_texture1], inputs[scale_texture2]);
}
