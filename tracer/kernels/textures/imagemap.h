// SPDX-License-Identifier: Apache-2.0
// An image over (u, v): u to the right, v downwards, (0, 0) its top left corner, as LuxCore has it.
// Texels stand in the tables, linear, three floats each, row 0 at the top.
#pragma once

#include "tracer/kernels/texture.h"

#define DS_IMAGEMAP_INPUTS(INPUT)
#define DS_IMAGEMAP_NUMBERS(NUMBER)
enum { imagemap_inputs = 0 };
DS_TRAITS(imagemap, k_trait_uv);
#ifdef DS_HOOK_HOST
inline constexpr NodeOnHost imagemap_on_host{};
#endif

/// The words behind an imagemap instruction.
enum {
  imagemap_texels,  ///< offset in tables, bits of an unsigned number
  imagemap_width,
  imagemap_height,
  imagemap_wrap,    ///< 0 repeat, 1 black, 2 white, 3 clamp
  imagemap_linear,  ///< 1: bilinear, 0: nearest
  imagemap_numbers
};

/// Column or row `i`, brought into [0, size) by the wrap mode; `*outside` where black or white
/// takes its place.
DS_FN natural imagemap_wrapped(integer i, uint size, uint wrap, mask* outside) {
  const integer n = (integer)((int)size);
  if (wrap == 0u) {
    const integer r = i % n;
    return to_natural_bits(choose_integer(r < 0, r + n, r));
  }
  *outside = *outside | (i < 0) | (i >= n);
  const integer low = choose_integer(i < 0, (integer)(0), i);
  return to_natural_bits(choose_integer(low >= n, n - 1, low));
}

DS_FN real3 imagemap_texel(TexturePoint at, DS_GLOBAL float* numbers, integer column, integer row) {
  const uint wrap = as_uint(numbers[imagemap_wrap]);
  mask outside = (mask)(0);
  const natural x = imagemap_wrapped(column, as_uint(numbers[imagemap_width]), wrap, &outside);
  const natural y = imagemap_wrapped(row, as_uint(numbers[imagemap_height]), wrap, &outside);
  const natural texel = (y * as_uint(numbers[imagemap_width]) + x) * 3u;
  const real3 inside = load3(at.tables + as_uint(numbers[imagemap_texels]), texel);
  if (wrap == 0u || wrap == 3u) return inside;
  return choose(outside, splat((real)(wrap == 2u ? 1.0f : 0.0f)), inside);
}

DS_FN real3 imagemap_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs) {
  const real x = at.u * (float)as_uint(numbers[imagemap_width]);
  const real y = at.v * (float)as_uint(numbers[imagemap_height]);
  if (as_uint(numbers[imagemap_linear]) == 0u) {
    return imagemap_texel(at, numbers, to_held_integer(floor(x)), to_held_integer(floor(y)));
  }
  const real left = floor(x - 0.5f);
  const real top = floor(y - 0.5f);
  const real fx = x - 0.5f - left;
  const real fy = y - 0.5f - top;
  const integer column = to_held_integer(left);
  const integer row = to_held_integer(top);
  const real3 above = lerp3(imagemap_texel(at, numbers, column, row),
                            imagemap_texel(at, numbers, column + 1, row), fx);
  const real3 below = lerp3(imagemap_texel(at, numbers, column, row + 1),
                            imagemap_texel(at, numbers, column + 1, row + 1), fx);
  return lerp3(above, below, fy);
}
