// SPDX-License-Identifier: Apache-2.0
// texture1 where the sum of the floors of the mesh's mapped u and v is even, texture2 where it is odd.
#pragma once

#include "tracer/kernels/texture.h"

#define DS_CHECKERBOARD2D_INPUTS(INPUT) \
  INPUT(checkerboard2d_texture1, 3, 1.0f) INPUT(checkerboard2d_texture2, 3, 0.0f)
#define DS_CHECKERBOARD2D_NUMBERS(NUMBER)
enum { DS_CHECKERBOARD2D_INPUTS(DS_INPUT_INDEX) checkerboard2d_inputs };
DS_TRAITS(checkerboard2d, k_trait_uv | k_trait_chooses);
#ifdef DS_HOOK_HOST
inline MaybeBounds checkerboard2d_bounds(std::span<const MaybeBounds> inputs,
                                         const float* numbers) {
  return either_bounds(inputs[checkerboard2d_texture1], inputs[checkerboard2d_texture2]);
}
inline constexpr Parameter checkerboard2d_parameters[] = {{"texture1", "where the sum is even"},
                                                          {"texture2", "where it is odd"}};
inline constexpr NodeOnHost checkerboard2d_on_host{.parameters = checkerboard2d_parameters,
                                                   .bounds = checkerboard2d_bounds};
#endif

DS_FN real3 checkerboard2d_evaluate(TexturePoint at, DS_GLOBAL float* numbers,
                                    const real3* inputs) {
  const integer odd = (to_held_integer(floor(at.u)) ^ to_held_integer(floor(at.v))) & 1;
  return choose(odd == 0, inputs[checkerboard2d_texture1], inputs[checkerboard2d_texture2]);
}
