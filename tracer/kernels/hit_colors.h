// SPDX-License-Identifier: Apache-2.0
// The colour that a mesh has at a point: its corners' as their weights mix them.
#pragma once

#include "tracer/kernels/texture.h"

/// Component `c` (red, green, blue, alpha) of the colour at a point. `offset`: where the rows of
/// colours start in the tables, bits of an unsigned number.
DS_FN real hit_color(TexturePoint at, float offset, uint c) {
  DS_GLOBAL float* colors = at.tables + as_uint(offset);
  const natural row = at.colors * (uint)k_color_words + c;
  const real b0 = 1.0f - at.b1 - at.b2;
  return fma(b0, load(colors, row),
             fma(at.b1, load(colors, row + 4u), at.b2 * load(colors, row + 8u)));
}
