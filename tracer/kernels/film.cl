// SPDX-License-Identifier: Apache-2.0
// The pixels that a work-item traces, and the film's sums of their samples.
#pragma once

#include "tracer/kernels/film_data.h"
#include "tracer/kernels/math.h"
#include "tracer/kernels/view_data.h"
#ifdef DS_HOOK_LIGHT_PLANES
#  include "tracer/kernels/light_planes.h"
#endif

/// The pixels that a work-item's lanes are at, one a lane.
typedef struct {
  natural index;       ///< y * width + x
  real x, y;           ///< of the pixel's centre
  natural begin, end;  ///< its first sample to trace, and the one behind the last
} Pixels;

/// The pixels that a work-item has not begun yet, by their numbers among those of all steps' tiles,
/// row by row: lanes look at neighbouring things.
typedef struct {
  const __global uint* steps;
  uint next, end;
} PixelQueue;

DS_FN PixelQueue pixel_queue(const __global uint* launch, uint item) {
  const uint share = launch[k_launch_share];
  PixelQueue queue;
  queue.steps = launch + k_launch_words;
  queue.next = item * share;
  queue.end = min(queue.next + share, launch[k_launch_steps] * (uint)k_tile_pixels);
  return queue;
}

/// The running sums of the lanes' pixels. The rare planes (from k_film_nan on) stay in the film.
enum { k_sums = k_film_nan };
#define k_no_pixel (~(size_t)0)
typedef struct {
  float plane[k_sums][DS_LANES] __attribute__((aligned(64)));
  size_t place[DS_LANES];  ///< of each lane's pixel in the film: plane 0; or k_no_pixel
  __global float* film;
  float limit;  ///< ViewData::sample_limit
#ifdef DS_HOOK_LIGHT_PLANES
  LightSums light;
  real accepted;  ///< what share of the samples that were added last was
#endif
} Sums;

DS_FN real* sum_of(Sums* sums, uint plane) {
  return (real*)sums->plane[plane];
}

DS_FN void clear_sums(Sums* sums, __global float* film, const ViewData* view) {
  sums->film = film;
  sums->limit = view->sample_limit;
  for (int i = 0; i < k_sums; ++i)
    *sum_of(sums, (uint)i) = (real)(0.0f);
  for (int lane = 0; lane < DS_LANES; ++lane)
    sums->place[lane] = k_no_pixel;
}

/// Writes a lane's sums to the film and reads those of its next pixel, either where there is one.
DS_FN void change_sums(Sums* sums, int lane, size_t next) {
  const size_t last = sums->place[lane];
#ifdef DS_HOOK_LIGHT_PLANES
  change_light_sums(&sums->light, lane, last, next, k_no_pixel);
#endif
  for (int i = 0; i < k_sums; ++i) {
    if (last != k_no_pixel) sums->film[last + (uint)(i * k_tile_pixels)] = sums->plane[i][lane];
    if (next != k_no_pixel) sums->plane[i][lane] = sums->film[next + (uint)(i * k_tile_pixels)];
  }
  sums->place[lane] = next;
}

/// Puts the pixels of the lanes in `finished` away and gives each of these the queue's next one in
/// the picture; returns those that got one. Pixels are many, so lanes stay busy though some pixels
/// take longer, and a pixel is one lane's.
DS_FN mask change_pixels(Pixels* pixels, Sums* sums, PixelQueue* queue, const ViewData* view,
                         mask finished) {
  uint index[DS_LANES] __attribute__((aligned(64)));
  uint begin[DS_LANES] __attribute__((aligned(64)));
  uint end[DS_LANES] __attribute__((aligned(64)));
  float xs[DS_LANES] __attribute__((aligned(64)));
  float ys[DS_LANES] __attribute__((aligned(64)));
  int wanted[DS_LANES] __attribute__((aligned(64)));
  *(natural*)index = pixels->index;
  *(natural*)begin = pixels->begin;
  *(natural*)end = pixels->end;
  *(real*)xs = pixels->x;
  *(real*)ys = pixels->y;
  *(mask*)wanted = finished;
  for (int lane = 0; lane < DS_LANES; ++lane) {
    if (!wanted[lane]) continue;
    wanted[lane] = 0;
    size_t place = k_no_pixel;
    while (place == k_no_pixel && queue->next < queue->end) {
      const uint number = queue->next++;
      const __global uint* step = queue->steps + number / (uint)k_tile_pixels * (uint)k_step_words;
      const uint tile = step[k_step_tile];
      const uint i = number % (uint)k_tile_pixels;
      const uint x = tile % view->tiles_x * (uint)k_tile_side + i % (uint)k_tile_side;
      const uint y = tile / view->tiles_x * (uint)k_tile_side + i / (uint)k_tile_side;
      if (x >= view->width || y >= view->height) continue;
      place = (size_t)tile * (uint)(k_film_planes * k_tile_pixels) + i;
      index[lane] = y * view->width + x;
      xs[lane] = (float)x + 0.5f;
      ys[lane] = (float)y + 0.5f;
      begin[lane] = step[k_step_begin];
      end[lane] = step[k_step_end];
      wanted[lane] = -1;
    }
    change_sums(sums, lane, place);
  }
  pixels->index = *(natural*)index;
  pixels->begin = *(natural*)begin;
  pixels->end = *(natural*)end;
  pixels->x = *(real*)xs;
  pixels->y = *(real*)ys;
  return *(mask*)wanted != 0;
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
    sums->film[sums->place[lane] + kind * (uint)k_tile_pixels] += 1.0f;
    wanted[lane] = kind == k_film_outliers ? -1 : 0;
    if (kind != k_film_outliers) continue;
    const float factor = sums->limit / as_float(greatest);
    const float energy =
        0.2126f * sample[0][lane] + 0.7152f * sample[1][lane] + 0.0722f * sample[2][lane];
    sums->film[sums->place[lane] + (uint)(k_film_removed * k_tile_pixels)] +=
        energy * (1.0f - factor);
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
#ifdef DS_HOOK_LIGHT_PLANES
  const real whole = max_component(radiance);
#endif
  const mask in_range = is_within(radiance.x, sums->limit) & is_within(radiance.y, sums->limit) &
                        is_within(radiance.z, sums->limit);
  mask good = done & in_range;
  const mask odd = done & !in_range;
  if (any_lane(odd)) good = good | tame_samples(sums, &radiance, odd);
#ifdef DS_HOOK_LIGHT_PLANES
  sums->accepted =
      choose(good, choose(odd, max_component(radiance) / whole, (real)(1.0f)), (real)(0.0f));
#endif
  const mask even = (number & 1u) == 0u;
  const real sample[3] = {radiance.x, radiance.y, radiance.z};
  for (uint q = 0; q < 4u; ++q) {
    const mask here = done & (quarter == q);
    if (!any_lane(here)) continue;
    const uint first = q * (uint)k_film_quarter;
    for (uint c = 0; c < 3u; ++c) {
      const real x = choose(good & here, sample[c], (real)(0.0f));
      real* sum = sum_of(sums, first + (uint)k_film_sum + c);
#ifdef DS_PLAIN_SUMS  // only to tell what compensating costs
      *sum = *sum + x;
#else
      add_compensated(sum, sum_of(sums, first + (uint)k_film_compensation + c), x);
#endif
      real* halves = sum_of(sums, first + (uint)k_film_halves + c);
      *halves = *halves + choose(even, x, -x);
    }
    const real one = choose(here, (real)(1.0f), (real)(0.0f));
    real* count = sum_of(sums, first + (uint)k_film_count);
    real* count_halves = sum_of(sums, first + (uint)k_film_count_halves);
    *count = *count + one;
    *count_halves = *count_halves + choose(even, one, -one);
  }
}
