// SPDX-License-Identifier: Apache-2.0
// One channel of the mesh's colour at a point (0 red, 1 green, 2 blue), or, at -1,
// its luminance as LuxCore weighs it.
#pragma once

#include "tracer/kernels/hit_colors.h"

#define DS_HITPOINTGREY_INPUTS(INPUT)
#define DS_HITPOINTGREY_NUMBERS(NUMBER) NUMBER(hitpointgrey_channel, -1.0f)
/// Behind the numbers: where the rows of colours start in the tables.
enum { DS_HITPOINTGREY_NUMBERS(DS_NUMBER_INDEX) hitpointgrey_offset };
enum { hitpointgrey_inputs = 0 };
DS_TRAITS(hitpointgrey, k_trait_colors);
#ifdef DS_HOOK_HOST
inline MaybeBounds hitpointgrey_bounds(std::span<const MaybeBounds> inputs, const float* numbers) {
  return bounds_from_to(0, 1, true);
}
inline constexpr Parameter hitpointgrey_parameters[] = {{"channel",
                                                         "-1: luminance, 0: red, 1: green, 2: blue",
                                                         {.least = -1, .most = 2},
                                                         ParameterKind::whole}};
inline constexpr NodeOnHost hitpointgrey_on_host{.parameters = hitpointgrey_parameters,
                                                 .bounds = hitpointgrey_bounds};
#endif

DS_FN real3 hitpointgrey_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs) {
  const float offset = numbers[hitpointgrey_offset];
  const float channel = numbers[hitpointgrey_channel];
  if (channel == 0.0f) return splat(hit_color(at, offset, 0u));
  if (channel == 1.0f) return splat(hit_color(at, offset, 1u));
  if (channel == 2.0f) return splat(hit_color(at, offset, 2u));
  return splat(fma(
      (real)(0.212671f), hit_color(at, offset, 0u),
      fma((real)(0.715160f), hit_color(at, offset, 1u), 0.072169f * hit_color(at, offset, 2u))));
}
