// SPDX-License-Identifier: Apache-2.0
// The difference of two textures; may be negative.
#pragma once

#include "tracer/kernels/texture.h"

#define DS_SUBTRACT_INPUTS(INPUT) \
  INPUT(subtract_texture1, 3, 1.0f) INPUT(subtract_texture2, 3, 1.0f)
#define DS_SUBTRACT_NUMBERS(NUMBER)
enum { DS_SUBTRACT_INPUTS(DS_INPUT_INDEX) subtract_inputs };
DS_TRAITS(subtract, 0);
#ifdef DS_HOOK_HOST
inline MaybeBounds subtract_bounds(std::span<const MaybeBounds> inputs, const float* numbers) {
  return combined_bounds(inputs[subtract_texture1], inputs[subtract_texture2], std::minus());
}
inline constexpr Parameter subtract_parameters[] = {{"texture1", "what is taken from"},
                                                    {"texture2", "what is taken"}};
inline constexpr NodeOnHost subtract_on_host{.parameters = subtract_parameters,
                                             .bounds = subtract_bounds};
#endif

DS_FN real3 subtract_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs) {
  return sub(inputs[subtract_texture1], inputs[subtract_texture2]);
}
