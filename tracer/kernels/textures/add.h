// SPDX-License-Identifier: Apache-2.0
// The sum of two textures.
#pragma once

#include "tracer/kernels/texture.h"

#define DS_ADD_INPUTS(INPUT) INPUT(add_texture1, 3, 1.0f) INPUT(add_texture2, 3, 1.0f)
#define DS_ADD_NUMBERS(NUMBER)
enum { DS_ADD_INPUTS(DS_INPUT_INDEX) add_inputs };
DS_TRAITS(add, 0);
#ifdef DS_HOOK_HOST
inline MaybeBounds add_bounds(std::span<const MaybeBounds> inputs, const float* numbers) {
  return combined_bounds(inputs[add_texture1], inputs[add_texture2], std::plus());
}
inline constexpr Parameter add_parameters[] = {{"texture1", "a term"}, {"texture2", "a term"}};
inline constexpr NodeOnHost add_on_host{.parameters = add_parameters, .bounds = add_bounds};
#endif

DS_FN real3 add_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs) {
  return add(inputs[add_texture1], inputs[add_texture2]);
}
