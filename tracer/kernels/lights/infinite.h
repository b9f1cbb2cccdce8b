// SPDX-License-Identifier: Apache-2.0
// A lat-long picture all around: Z up, the zenith in the top row. As in LuxCore it is seen mirrored
// from inside; transformation = 1 0 0 0  0 -1 0 0  0 0 1 0  0 0 0 1 turns that round.
//
// Looked up bilinearly: round in longitude, held at the poles. Sampled in proportion to the
// luminance of the very function looked up: its domain is cut into cells between texel centres
// (width columns, height + 1 rows, the first and last of half height), a cell's weight is the mean
// of its four corners times the sine of its polar angle, so no direction with radiance has a pdf of
// 0. A cell is found by its row's cumulative table, then the column's, which keeps the samples'
// stratification.
#pragma once

#include "tracer/kernels/light.h"

#ifdef DS_HOOK_HOST
inline constexpr LightInput infinite_inputs[] = {{"color", LightValue::color}};
inline constexpr LightOnHost infinite_on_host = {infinite_inputs,
                                                 k_host_reads | k_host_tables | k_host_panorama};
#endif

enum {
  infinite_width = 0,  ///< texels, bits of an unsigned number
  infinite_height = 1,
  infinite_texels = 2,  ///< offset in tables of the texels, row 0 at the pole +z of light space
  infinite_shared_exponent = 3,  ///< 1: a texel is one word, mantissas of r, g, b from the lowest
                                 ///< byte up, then the exponent of their common scale as a float's;
                                 ///< 0: it is 3 floats
  infinite_color = 4,            ///< 3: factor of all texels
  infinite_rows = 7,             ///< offset in tables: height + 1 cumulative row probabilities
  infinite_row_densities = 8,    ///< offset in tables: for each row, a cell's pdf over (azimuth,
                                 ///< polar angle), per radian^2, by its mean luminance
  infinite_columns = 9,          ///< offset in tables: for each row, cumulative column
                                 ///< probabilities, filled up with 1 to whole blocks
  infinite_blocks = 10,          ///< offset in tables: for each row, the last entry of each block
  infinite_to_light = 11,        ///< 9: rotation, row-major, world to light space
  k_column_block = 16,           ///< entries of a block: one cache line
};
DS_TRAITS(infinite, k_trait_beyond | k_trait_sampled);

/// A direction of light space (+z up) in the image; the middle column looks along +x, columns to
/// its left towards +y.
typedef struct {
  real column, row;  ///< in texels, 0 at the left and top edges
  real sine;         ///< of the polar angle
} LatLong;

DS_FN LatLong lat_long_of(real3 d, float width, float height) {
  LatLong p;
  const real turns = arctangent_turns(d.y, d.x);
  p.column = (0.5f - turns) * width;
  p.row = arccosine_turns(d.z) * (2.0f * height);
  p.sine = safe_sqrt(d.x * d.x + d.y * d.y);
  return p;
}

DS_FN real3 lat_long_direction(real column, real row, float width, float height, real* sine) {
  const SinCos azimuth = sin_cos_turns(0.5f - column / width);
  const SinCos polar = sin_cos_turns(row / (2.0f * height));
  *sine = polar.sin;
  return vec(polar.sin * azimuth.cos, polar.sin * azimuth.sin, polar.cos);
}

DS_FN real3 infinite_texel(DS_GLOBAL float* texels, bool shared_exponent, natural i) {
  if (!shared_exponent) return load3(texels, i * 3u);
  const natural word = load_natural(texels, i);
  return scale(vec(to_real(word & 255u), to_real((word >> 8) & 255u), to_real((word >> 16) & 255u)),
               real_of((word >> 24) << 23));
}

/// What a cell holds at a point of it.
typedef struct {
  real3 radiance;
  real density;  ///< of sampling it: per radian of azimuth and of polar angle
} CellPoint;

/// Bilinear radiance within cell (column, row) at fractions fx, fy of it.
DS_OUT_OF_LINE CellPoint infinite_cell(LightTables t, DS_GLOBAL float* p, natural column,
                                       natural row, real fx, real fy) {
  const uint width = as_uint(p[infinite_width]);
  const uint height = as_uint(p[infinite_height]);
  const bool shared = as_uint(p[infinite_shared_exponent]) != 0u;
  DS_GLOBAL float* texels = t.tables + as_uint(p[infinite_texels]);
  const natural left = choose_natural(column == 0u, (natural)(width - 1u), column - 1u);
  const natural above = choose_natural(row == 0u, (natural)(0u), row - 1u) * width;
  const natural below = choose_natural(row >= height, (natural)(height - 1u), row) * width;
  const real3 above_left = infinite_texel(texels, shared, above + left);
  const real3 above_right = infinite_texel(texels, shared, above + column);
  const real3 below_left = infinite_texel(texels, shared, below + left);
  const real3 below_right = infinite_texel(texels, shared, below + column);
  const real3 sum = add(add(above_left, above_right), add(below_left, below_right));
  CellPoint c;
  c.radiance =
      mul(lerp3(lerp3(above_left, above_right, fx), lerp3(below_left, below_right, fx), fy),
          uniform3(p + infinite_color));
  c.density = luminance(sum) * 0.25f * load(t.tables + as_uint(p[infinite_row_densities]), row);
  return c;
}

DS_FN real3 infinite_escape(LightTables t, uint at, real3 direction, real* pdf) {
  DS_GLOBAL float* p = t.lights + at;
  DS_GLOBAL float* m = p + infinite_to_light;
  const uint width = as_uint(p[infinite_width]);
  const uint height = as_uint(p[infinite_height]);
  const real3 d = vec(dot(direction, uniform3(m)), dot(direction, uniform3(m + 3)),
                      dot(direction, uniform3(m + 6)));
  const LatLong where = lat_long_of(d, (float)width, (float)height);
  // The bound is never passed but by NaN, which must not leave the tables.
  const real x = lesser(where.column + 0.5f, (real)((float)width + 0.5f));
  const real y = where.row + 0.5f;
  const natural whole_x = to_natural(x);
  const natural column = choose_natural(whole_x >= width, whole_x - width, whole_x);
  const natural row = to_natural(lesser(y, (real)((float)height + 0.49f)));
  const CellPoint cell = infinite_cell(t, p, column, row, x - floor(x), y - floor(y));
  *pdf = cell.density / greater(where.sine, (real)(1e-6f));
  return cell.radiance;
}

DS_FN LightSample infinite_sample(LightTables t, uint at, real3 from, real2 u) {
  DS_GLOBAL float* p = t.lights + at;
  DS_GLOBAL float* m = p + infinite_to_light;
  const uint width = as_uint(p[infinite_width]);
  const uint height = as_uint(p[infinite_height]);
  DS_GLOBAL float* rows = t.tables + as_uint(p[infinite_rows]);
  DS_GLOBAL float* columns = t.tables + as_uint(p[infinite_columns]);
  const natural row = find_interval(rows, (natural)(0u), height + 1u, u.y);
  // The search goes through the blocks' last entries, few enough to stay in a cache, then through
  // one block: the same entry as a search of the whole row finds, for one line of memory.
  const uint blocks = (width + k_column_block - 1) / k_column_block;
  DS_GLOBAL float* block_ends = t.tables + as_uint(p[infinite_blocks]);
  const natural row_start = row * (blocks * k_column_block);
  const natural block = find_interval(block_ends, row * blocks, blocks, u.x) * (uint)k_column_block;
  const natural found =
      block + find_interval(columns, row_start + block, (uint)k_column_block, u.x);
  const natural column = choose_natural(found < width, found, (natural)(width - 1u));
  const real row_low = interval_start(rows, (natural)(0u), row);
  const real column_low = interval_start(columns, row_start, column);
  const real row_share = load(rows, row) - row_low;
  const real column_share = load(columns, row_start + column) - column_low;
  const real fx = clamp01((u.x - column_low) / greater(column_share, (real)(1e-20f)));
  const real in_row = clamp01((u.y - row_low) / greater(row_share, (real)(1e-20f)));
  // The first row has its lower half only, the last its upper half.
  const real fy =
      choose(row == 0u, 0.5f + 0.5f * in_row, choose(row == height, 0.5f * in_row, in_row));
  real sine;
  const real3 d = lat_long_direction(to_real(column) + fx - 0.5f, to_real(row) + fy - 0.5f,
                                     (float)width, (float)height, &sine);
  LightSample s = no_light();
  s.wi = unit(
      add_scaled(add_scaled(scale(uniform3(m), d.x), uniform3(m + 3), d.y), uniform3(m + 6), d.z));
  const CellPoint cell = infinite_cell(t, p, column, row, fx, fy);
  s.radiance = cell.radiance;
  s.pdf = choose(sine > 1e-6f, cell.density / greater(sine, (real)(1e-6f)), (real)(0.0f));
  return s;
}
