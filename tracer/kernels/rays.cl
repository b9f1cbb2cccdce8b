// SPDX-License-Identifier: Apache-2.0
// Single rays, for picking, tests against an oracle, and the ray benchmark.
#include "tracer/kernels/batch.cl"

DS_FN Ray read_ray(const __global float* rays, uint i) {
  Ray ray;
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = rays[7 * i + axis];
    ray.direction[axis] = rays[7 * i + 3 + axis];
  }
  ray.t_max = rays[7 * i + 6];
  return ray;
}

/// rays: origin, direction, t_max (7 floats each). hits: t, b1, b2, id (4 words each).
__kernel void trace_nearest(const __global float8* restrict nodes,
                            const __global float8* restrict leaves,
                            const __global float* restrict rays, __global float* restrict hits) {
  const uint i = get_global_id(0);
  const Hit hit = nearest_hit(nodes, leaves, read_ray(rays, i));
  hits[4 * i] = hit.t;
  hits[4 * i + 1] = hit.b1;
  hits[4 * i + 2] = hit.b2;
  hits[4 * i + 3] = as_float(hit.id);
}

/// answers: 1 where something is hit.
__kernel void trace_any(const __global float8* restrict nodes,
                        const __global float8* restrict leaves, const __global float* restrict rays,
                        __global uint* restrict answers) {
  const uint i = get_global_id(0);
  answers[i] = any_hit(nodes, leaves, read_ray(rays, i)) ? 1u : 0u;
}

DS_FN LaneRays read_rays(DS_GLOBAL float* rays, natural at) {
  LaneRays r;
  r.origin = load3(rays, at);
  r.direction = load3(rays, at + 3u);
  r.t_max = load(rays, at + 6u);
  r.wanted = r.t_max == r.t_max;
  return r;
}

/// As the path tracer asks: DS_LANES rays an item. hits: t and id of each ray (2 words each).
/// answers: as trace_any's, filled where `ask_any` is not 0.
__kernel void trace_batches(const __global float8* restrict nodes,
                            const __global float8* restrict leaves,
                            const __global float* restrict rays, uint ask_any,
                            __global float* restrict hits, __global uint* restrict answers) {
  const uint first = (uint)get_global_id(0) * DS_LANES;
  const LaneRays nearest = read_rays(rays, (first + DS_LANE_NUMBERS) * 7u);
  LaneRays any = nearest;
  any.wanted = nearest.wanted & (ask_any != 0 ? (mask)(-1) : (mask)(0));
  BatchHits found;
  trace_lanes(nodes, leaves, &nearest, &any, &found);
  for (uint lane = 0; lane < DS_LANES; ++lane) {
    hits[2 * (first + lane)] = found.t[lane];
    hits[2 * (first + lane) + 1] = as_float(found.id[lane]);
    if (ask_any != 0) answers[first + lane] = found.any[lane] != 0 ? 1u : 0u;
  }
}
