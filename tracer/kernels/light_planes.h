// SPDX-License-Identifier: Apache-2.0
// Planes of light beside a picture: what paths bring to each, and the sums of that by pixel. The
// hook DS_HOOK_LIGHT_PLANES puts this into the path tracer. DS_LIGHT_PLANES(X) is the list of those
// asked for, X(name, number), DS_LIGHT_PLANE_COUNT of them (device/program_text.cc writes it).
#pragma once

#include "tracer/kernels/contribution.h"
#include "tracer/kernels/film_data.h"
#include "tracer/kernels/light_film_data.h"
#include "tracer/kernels/math.h"

/// A sample's light in each plane.
typedef struct {
  real3 plane[DS_LIGHT_PLANE_COUNT];
} PlaneLight;

DS_FN void contribute(PlaneLight* planes, mask here, const Contribution* c, real3 light) {
#define DS_TAKE(name, number)                                                                   \
  planes->plane[number] = choose(here, add(planes->plane[number], mul(name##_takes(c), light)), \
                                 planes->plane[number]);
  DS_LIGHT_PLANES(DS_TAKE)
}

#ifdef DS_COVERAGE_PLANES
/// The camera's rays meet something.
DS_FN void cover(PlaneLight* planes, mask here) {
#  define DS_COVER(name, number) \
    planes->plane[number] = choose(here, splat((real)(1.0f)), planes->plane[number]);
  DS_COVERAGE_PLANES(DS_COVER)
}
#endif

DS_FN void copy_light(PlaneLight* to, mask here, const PlaneLight* from) {
  for (int i = 0; i < DS_LIGHT_PLANE_COUNT; ++i)
    to->plane[i] = choose(here, from->plane[i], to->plane[i]);
}

DS_FN void clear_light(PlaneLight* planes, mask here) {
  for (int i = 0; i < DS_LIGHT_PLANE_COUNT; ++i)
    planes->plane[i] = choose(here, splat((real)(0.0f)), planes->plane[i]);
}

/// The running sums of the lanes' pixels, as light_film_data.h lays them out.
enum { k_light_rows = DS_LIGHT_PLANE_COUNT * k_light_plane };
typedef struct {
  float row[k_light_rows][DS_LANES] __attribute__((aligned(64)));
  __global float* film;
} LightSums;

DS_FN void clear_light_sums(LightSums* sums, __global float* film) {
  sums->film = film;
  for (int i = 0; i < k_light_rows; ++i)
    *(real*)sums->row[i] = (real)(0.0f);
}

/// As change_sums of film.cl, for pixels at these places of the picture's film.
DS_FN void change_light_sums(LightSums* sums, int lane, size_t last, size_t next, size_t none) {
  const size_t tile = k_film_planes * k_tile_pixels;
  const size_t light_tile = k_light_rows * k_tile_pixels;
  __global float* to = sums->film + (last == none ? 0 : last / tile * light_tile + last % tile);
  const __global float* from =
      sums->film + (next == none ? 0 : next / tile * light_tile + next % tile);
  for (int i = 0; i < k_light_rows; ++i) {
    if (last != none) to[i * k_tile_pixels] = sums->row[i][lane];
    if (next != none) sums->row[i][lane] = from[i * k_tile_pixels];
  }
}

/// Adds what finished samples in `done` have, scaled as the picture's own were when they were added:
/// 0 where they were not.
DS_FN void add_light(LightSums* sums, mask done, natural quarter, real accepted,
                     const PlaneLight* light) {
  real parts[DS_LIGHT_PLANE_COUNT];
  for (uint i = 0; i < (uint)DS_LIGHT_PLANE_COUNT; ++i)
    parts[i] = accepted;
#ifdef DS_COVERAGE_PLANES
#  define DS_WHOLE(name, number) parts[number] = (real)(1.0f);
  DS_COVERAGE_PLANES(DS_WHOLE)
#endif
  for (uint q = 0; q < 4u; ++q) {
    const mask here = done & (quarter == q) & (accepted > 0.0f);
    if (!any_lane(here)) continue;
    for (uint i = 0; i < (uint)DS_LIGHT_PLANE_COUNT; ++i) {
      const real3 rgb = choose(here, scale(light->plane[i], parts[i]), splat((real)(0.0f)));
      const real sample[3] = {rgb.x, rgb.y, rgb.z};
      const uint first = i * (uint)k_light_plane + q * (uint)k_light_quarter;
      for (uint c = 0; c < 3u; ++c)
        add_compensated((real*)sums->row[first + (uint)k_light_sum + c],
                        (real*)sums->row[first + (uint)k_light_compensation + c], sample[c]);
    }
  }
}
