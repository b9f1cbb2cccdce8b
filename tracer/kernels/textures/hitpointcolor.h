// SPDX-License-Identifier: Apache-2.0
// The colour that the mesh has at a point; white where it has none.
#pragma once

#include "tracer/kernels/hit_colors.h"

#define DS_HITPOINTCOLOR_INPUTS(INPUT)
#define DS_HITPOINTCOLOR_NUMBERS(NUMBER)
/// Behind the numbers: where the rows of colours start in the tables.
enum { hitpointcolor_offset };
enum { hitpointcolor_inputs = 0 };
DS_TRAITS(hitpointcolor, k_trait_colors);
#ifdef DS_HOOK_HOST
inline MaybeBounds hitpointcolor_bounds(std::span<const MaybeBounds> inputs, const float* numbers) {
  return bounds_from_to(0, 1, true);
}
inline constexpr NodeOnHost hitpointcolor_on_host{.parameters = {}, .bounds = hitpointcolor_bounds};
#endif

DS_FN real3 hitpointcolor_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs) {
  const float offset = numbers[hitpointcolor_offset];
  return vec(hit_color(at, offset, 0u), hit_color(at, offset, 1u), hit_color(at, offset, 2u));
}
