// SPDX-License-Identifier: Apache-2.0
// Counts the rays of a picture where a program is built with -DDS_COUNT_RAYS; in any other program
// these macros are nothing. Each lane counts its own; a work-item stores k_ray_counts sums in a row
// of its own, which the host adds up.
#pragma once

#include "tracer/kernels/lanes.h"
#include "tracer/kernels/ray_counts_data.h"

#ifdef DS_COUNT_RAYS

typedef struct {
  natural of[k_ray_counts];
} LaneRayCounts;

DS_FN natural one_where(mask m) {
  return choose_natural(m, (natural)(1u), (natural)(0u));
}

DS_FN void store_ray_counts(const LaneRayCounts* counts, __global uint* row) {
  uint lanes[DS_LANES] __attribute__((aligned(64)));
  for (int i = 0; i < k_ray_counts; ++i) {
    *(natural*)lanes = counts->of[i];
    uint sum = 0;
    for (int lane = 0; lane < DS_LANES; ++lane)
      sum += lanes[lane];
    row[i] += sum;
  }
}

#  define DS_RAY_COUNTS_ARGUMENT , __global uint* restrict ray_counts
#  define DS_RAY_COUNTS_FIELD LaneRayCounts counts;
#  define DS_CLEAR_RAY_COUNTS(paths)       \
    for (int i = 0; i < k_ray_counts; ++i) \
    (paths).counts.of[i] = (natural)(0u)
/// Before a step traces: camera rays are those of paths that have visited no surface.
#  define DS_COUNT_STEP(paths)                                                                     \
    (paths)->counts.of[k_count_camera] += one_where((paths)->alive & ((paths)->vertices == 0u));   \
    (paths)->counts.of[k_count_extension] += one_where((paths)->alive & ((paths)->vertices > 0u)); \
    (paths)->counts.of[k_count_shadow] += one_where((paths)->shadow.wanted)
#  define DS_RAY_COUNTS_PASSED , ray_counts + get_global_id(0) * k_ray_counts
#  define DS_STORE_RAY_COUNTS(paths) store_ray_counts(&(paths).counts, ray_counts)

#else

#  define DS_RAY_COUNTS_ARGUMENT
#  define DS_RAY_COUNTS_FIELD
#  define DS_CLEAR_RAY_COUNTS(paths)
#  define DS_COUNT_STEP(paths)
#  define DS_RAY_COUNTS_PASSED
#  define DS_STORE_RAY_COUNTS(paths)

#endif
