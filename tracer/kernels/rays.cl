// SPDX-License-Identifier: Apache-2.0
// Single rays, for picking, tests against an oracle, and the ray benchmark.
#include "tracer/kernels/bvh.cl"

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
