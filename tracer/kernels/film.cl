// SPDX-License-Identifier: Apache-2.0
// The pixels that a work-item traces, and the film's sums of their samples.
#pragma once

#include "tracer/kernels/math.h"
#include "tracer/kernels/types.h"

typedef struct {
  natural index;  ///< y * width + x; 0 where outside
  real x, y;      ///< of the pixel's centre
  mask inside;
} Pixels;

/// Pixels of a work-item in its tile, row by row: lanes look at neighbouring things. `first`: place
/// in the tile of lane 0's pixel.
DS_FN Pixels pixels_of(uint tile, uint first, const ViewData* view) {
  const natural i = first + DS_LANE_NUMBERS;
  const natural x = (tile % view->tiles_x) * (uint)k_tile_side + i % (uint)k_tile_side;
  const natural y = (tile / view->tiles_x) * (uint)k_tile_side + i / (uint)k_tile_side;
  Pixels p;
  p.inside = (x < view->width) & (y < view->height);
  p.index = choose_natural(p.inside, y * view->width + x, (natural)(0u));
  p.x = to_real(x) + 0.5f;
  p.y = to_real(y) + 0.5f;
  return p;
}

/// The pixels' running sums while this work-item works on them. The rare planes (from k_film_nan
/// on) stay in the film.
enum { k_sums = k_film_nan };
typedef struct {
  real plane[k_sums];
  __global float* film;  ///< plane 0 of lane 0's pixel
  float limit;           ///< ViewData::sample_limit
} Sums;

DS_FN void load_sums(Sums* sums, __global float* film, uint tile, uint first,
                     const ViewData* view) {
  sums->film = film + (size_t)tile * (uint)(k_film_planes * k_tile_pixels) + first;
  sums->limit = view->sample_limit;
  for (int i = 0; i < k_sums; ++i)
    sums->plane[i] = *(const __global real*)(sums->film + i * k_tile_pixels);
}

DS_FN void store_sums(const Sums* sums) {
  for (int i = 0; i < k_sums; ++i)
    *(__global real*)(sums->film + i * k_tile_pixels) = sums->plane[i];
}

/// Counts the samples of `odd` by what is wrong with them and scales outliers down; returns the
/// lanes of these, which are good now. By bits, since fast math takes NaN for impossible.
DS_FN mask tame_samples(const Sums* sums, real3* radiance, mask odd) {
  float sample[3][DS_LANES] __attribute__((aligned(64)));
  int wanted[DS_LANES] __attribute__((aligned(64)));
  *(real*)sample[0] = radiance->x;
  *(real*)sample[1] = radiance->y;
  *(real*)sample[2] = radiance->z;
  *(mask*)wanted = odd;
  for (int lane = 0; lane < DS_LANES; ++lane) {
    if (!wanted[lane]) continue;
    uint greatest = 0u;
    bool negative = false;
    for (int c = 0; c < 3; ++c) {
      const uint bits = as_uint(sample[c][lane]);
      greatest = max(greatest, bits & 0x7fffffffu);
      negative = negative || (bits > 0x80000000u);
    }
    const uint kind = greatest > 0x7f800000u              ? k_film_nan
                      : greatest > as_uint(k_sample_most) ? k_film_infinite
                      : negative                          ? k_film_negative
                                                          : k_film_outliers;
    sums->film[kind * (uint)k_tile_pixels + (uint)lane] += 1.0f;
    wanted[lane] = kind == k_film_outliers ? -1 : 0;
    if (kind != k_film_outliers) continue;
    const float factor = sums->limit / as_float(greatest);
    const float energy =
        0.2126f * sample[0][lane] + 0.7152f * sample[1][lane] + 0.0722f * sample[2][lane];
    sums->film[k_film_removed * k_tile_pixels + lane] += energy * (1.0f - factor);
    for (int c = 0; c < 3; ++c)
      sample[c][lane] *= factor;
  }
  *radiance = vec(*(real*)sample[0], *(real*)sample[1], *(real*)sample[2]);
  return *(mask*)wanted != 0;
}

/// Whether x is in [0, limit]. By bits, which floats >= 0 are ordered by: fast math would let NaN
/// pass.
DS_FN mask is_within(real x, float limit) {
  const natural bits = bits_of(x);
  return (bits <= as_uint(limit)) | (bits == 0x80000000u);
}

/// Adds the finished samples in `done`, by number, to the quarters of the pixels they are in.
DS_FN void add_samples(Sums* sums, mask done, natural number, natural quarter, real3 radiance) {
  const mask in_range = is_within(radiance.x, sums->limit) & is_within(radiance.y, sums->limit) &
                        is_within(radiance.z, sums->limit);
  mask good = done & in_range;
  const mask odd = done & !in_range;
  if (any_lane(odd)) good = good | tame_samples(sums, &radiance, odd);
  const mask even = (number & 1u) == 0u;
  const real sample[3] = {radiance.x, radiance.y, radiance.z};
  for (uint q = 0; q < 4u; ++q) {
    const mask here = done & (quarter == q);
    if (!any_lane(here)) continue;
    real* plane = sums->plane + q * (uint)k_film_quarter;
    for (int c = 0; c < 3; ++c) {
      const real x = choose(good & here, sample[c], (real)(0.0f));
#ifdef DS_PLAIN_SUMS  // only to tell what compensating costs
      plane[k_film_sum + c] = plane[k_film_sum + c] + x;
#else
      add_compensated(&plane[k_film_sum + c], &plane[k_film_compensation + c], x);
#endif
      plane[k_film_halves + c] = plane[k_film_halves + c] + choose(even, x, -x);
    }
    const real one = choose(here, (real)(1.0f), (real)(0.0f));
    plane[k_film_count] = plane[k_film_count] + one;
    plane[k_film_count_halves] = plane[k_film_count_halves] + choose(even, one, -one);
  }
}
