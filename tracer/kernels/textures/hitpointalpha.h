// SPDX-License-Identifier: Apache-2.0
// The alpha of the mesh's colour at a point; 1 where it has none.
#pragma once

#include "tracer/kernels/hit_colors.h"

#define DS_HITPOINTALPHA_INPUTS(INPUT)
#define DS_HITPOINTALPHA_NUMBERS(NUMBER)
/// Behind the numbers: where the rows of colours start in the tables.
enum { hitpointalpha_offset };
enum { hitpointalpha_inputs = 0 };
DS_TRAITS(hitpointalpha, k_trait_colors);
#ifdef DS_HOOK_HOST
inline MaybeBounds hitpointalpha_bounds(std::span<const MaybeBounds> inputs, const float* numbers) {
  return bounds_from_to(0, 1, true);
}
inline constexpr NodeOnHost hitpointalpha_on_host{.parameters = {}, .bounds = hitpointalpha_bounds};
#endif

DS_FN real3 hitpointalpha_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs) {
  return splat(hit_color(at, numbers[hitpointalpha_offset], 3u));
}
