// SPDX-License-Identifier: Apache-2.0
// ties.cl for the rays of all lanes, one by one: few of them ask.
#pragma once

#include "tracer/kernels/batch.cl"
#include "tracer/kernels/ties.cl"

typedef struct {
  float x[DS_LANES] __attribute__((aligned(64)));
  float y[DS_LANES] __attribute__((aligned(64)));
  float z[DS_LANES] __attribute__((aligned(64)));
} LaneVectors;

DS_FN LaneVectors lane_vectors(real3 v) {
  LaneVectors a;
  *(real*)a.x = v.x;
  *(real*)a.y = v.y;
  *(real*)a.z = v.z;
  return a;
}

/// Whether surfaces may tie with others where the lanes' points are.
DS_FN mask may_tie_at(const SceneData* scene, real3 at) {
  mask may = (mask)(0);
  for (uint i = 0; i < scene->tie_places; ++i) {
    const float* low = scene->tie_low[i];
    const float* high = scene->tie_high[i];
    may = may | ((at.x >= low[0]) & (at.x <= high[0]) & (at.y >= low[1]) & (at.y <= high[1]) &
                 (at.z >= low[2]) & (at.z <= high[2]));
  }
  return may;
}

/// Replaces the nearest hits of `asks` by what is met: top_hit. Tells whether any changed.
DS_OUT_OF_LINE bool top_hits(const __global float8* nodes, const __global float8* leaves,
                             DS_GLOBAL float* triangles, const LaneRays* rays, mask asks,
                             mask camera, BatchHits* found) {
  int wanted[DS_LANES] __attribute__((aligned(64)));
  int by_camera[DS_LANES] __attribute__((aligned(64)));
  *(mask*)wanted = asks;
  *(mask*)by_camera = camera;
  const LaneVectors origin = lane_vectors(rays->origin);
  const LaneVectors direction = lane_vectors(rays->direction);
  bool changed = false;
  for (int lane = 0; lane < DS_LANES; ++lane) {
    if (!wanted[lane]) continue;
    const Ray ray = {{origin.x[lane], origin.y[lane], origin.z[lane]},
                     {direction.x[lane], direction.y[lane], direction.z[lane]},
                     0.0f};
    const Hit nearest = {found->t[lane], 0.0f, 0.0f, found->id[lane]};
    const Hit top = top_hit(nodes, leaves, triangles, ray, nearest, by_camera[lane] != 0);
    changed = changed || top.id != nearest.id;
    found->t[lane] = top.t;
    found->id[lane] = top.id;
  }
  return changed;
}

/// next_layer of the lanes in `asks`, for rays from `origin` off the triangles `from`; k_none in
/// all others.
DS_OUT_OF_LINE natural next_layers(const __global float8* nodes, const __global float8* leaves,
                                   DS_GLOBAL float* triangles, real3 origin, natural from,
                                   mask rises, mask asks) {
  uint id[DS_LANES] __attribute__((aligned(64)));
  int rising[DS_LANES] __attribute__((aligned(64)));
  int wanted[DS_LANES] __attribute__((aligned(64)));
  *(natural*)id = from;
  *(mask*)rising = rises;
  *(mask*)wanted = asks;
  const LaneVectors origins = lane_vectors(origin);
  for (int lane = 0; lane < DS_LANES; ++lane) {
    const float at[3] = {origins.x[lane], origins.y[lane], origins.z[lane]};
    id[lane] = wanted[lane] ? next_layer(nodes, leaves, triangles, at, id[lane], rising[lane] != 0)
                            : k_none;
  }
  return *(natural*)id;
}
