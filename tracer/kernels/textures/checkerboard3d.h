// SPDX-License-Identifier: Apache-2.0
// texture1 where the sum of the floors of the coordinates is even, texture2 where it is odd.
#pragma once

#include "tracer/kernels/texture.h"

#define DS_CHECKERBOARD3D_INPUTS(INPUT) \
  INPUT(checkerboard3d_texture1, 3, 1.0f) INPUT(checkerboard3d_texture2, 3, 0.0f)
#define DS_CHECKERBOARD3D_NUMBERS(NUMBER)
enum { DS_CHECKERBOARD3D_INPUTS(DS_INPUT_INDEX) checkerboard3d_inputs };
DS_TRAITS(checkerboard3d, k_trait_position | k_trait_chooses);
#ifdef DS_HOOK_HOST
inline MaybeBounds checkerboard3d_bounds(std::span<const MaybeBounds> inputs,
                                         const float* numbers) {
  return either_bounds(inputs[checkerboard3d_texture1], inputs[checkerboard3d_texture2]);
}
inline constexpr Parameter checkerboard3d_parameters[] = {{"texture1", "where the sum is even"},
                                                          {"texture2", "where it is odd"}};
inline constexpr NodeOnHost checkerboard3d_on_host{.parameters = checkerboard3d_parameters,
                                                   .bounds = checkerboard3d_bounds};
#endif

DS_FN real3 checkerboard3d_evaluate(TexturePoint at, DS_GLOBAL float* numbers,
                                    const real3* inputs) {
  const real3 p = at.position;
  const integer odd =
      (to_held_integer(floor(p.x)) ^ to_held_integer(floor(p.y)) ^ to_held_integer(floor(p.z))) & 1;
  return choose(odd == 0, inputs[checkerboard3d_texture1], inputs[checkerboard3d_texture2]);
}
