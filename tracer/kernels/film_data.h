// SPDX-License-Identifier: Apache-2.0
// The film and what a launch adds to it, as word offsets that host and device share.
#pragma once

#include "tracer/kernels/language.h"

/// Greatest component of a sample that can be added at all; above it counts as infinite.
#define k_sample_most 1e30f

/// Pixels that samples are added to together: squares of 4x4.
enum { k_tile_side = 4, k_tile_pixels = 16 };

/// A film is a row of tiles, a tile k_film_planes rows of one float for each of its pixels; those
/// outside the picture stay zero. First come the sums of the four quarters of a pixel, the upper
/// left one, the upper right one, the lower left one and the lower right one, each of them:
enum {
  k_film_sum = 0,            ///< 3: r, g, b
  k_film_compensation = 3,   ///< 3: what rounding has cut off (add_compensated of math.h)
  k_film_halves = 6,         ///< 3: even samples minus odd ones: two independent halves
  k_film_count = 9,          ///< samples
  k_film_count_halves = 10,  ///< even ones minus odd ones
  k_film_quarter = 11,
};
/// Then what is seldom other than zero, of the whole pixel.
enum {
  k_film_nan = 4 * k_film_quarter,  ///< samples not added because a component was not a number, ...
  k_film_infinite,                  ///< ... was infinite or above k_sample_most, ...
  k_film_negative,                  ///< ... was negative; each sample has the first kind that fits
  k_film_outliers,                  ///< samples scaled down to ViewData::sample_limit
  k_film_removed,                   ///< luminance that this took from them
  k_film_planes,
};

/// What a launch traces: how many pixels a work-item takes, and how many steps follow; then for
/// each step its tile's number, row by row, and the numbers of the first sample of the tile's
/// pixels and of the one behind the last.
enum { k_launch_share = 0, k_launch_steps = 1, k_launch_words = 2 };
enum { k_step_tile = 0, k_step_begin = 1, k_step_end = 2, k_step_words = 3 };
