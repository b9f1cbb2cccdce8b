// SPDX-License-Identifier: Apache-2.0
// One ray a pixel, through its centre and the pinhole: which object, how deep. Needs no material,
// light or lens.
#include "tracer/kernels/scene_data.h"
#include "tracer/kernels/ties.cl"
#include "tracer/kernels/view_data.h"

DS_FN bool is_camera_invisible(const __global float* triangles, uint id) {
  const uint flags = as_uint(triangles[id * k_triangle_words + k_triangle_flags]);
  return (flags & k_flag_camera_invisible) != 0;
}

DS_FN Hit camera_hit(const __global float8* nodes, const __global float8* leaves,
                     const __global float* triangles, Ray ray) {
  const Hit hit = nearest_hit(nodes, leaves, ray);
  if (hit.id == k_none || !may_yield(tie_flags(triangles, hit.id), true)) return hit;
  return top_hit(nodes, leaves, triangles, ray, hit, true);
}

/// objects: object id of the nearest triangle, or k_none. depths: distance along the viewing axis
/// in metres, or 0.
__kernel void trace_geometry(const __global float8* restrict nodes,
                             const __global float8* restrict leaves,
                             const __global float* restrict triangles,
                             const __global ViewData* restrict view,
                             __global uint* restrict objects, __global float* restrict depths) {
  const uint i = get_global_id(0);
  if (i >= view->width * view->height) return;
  const float sx = 2.0f * ((float)(i % view->width) + 0.5f) / (float)view->width - 1.0f;
  const float sy = 1.0f - 2.0f * ((float)(i / view->width) + 0.5f) / (float)view->height;
  // The direction's part along the viewing axis is 1, so a hit's distance in lengths of it is the
  // planar depth.
  Ray ray;
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] =
        fma(sx, view->start_right[axis], fma(sy, view->start_up[axis], view->start[axis]));
    ray.direction[axis] = fma(sx, view->right[axis], fma(sy, view->up[axis], view->forward[axis]));
  }
  ray.t_max = 1e30f;
  Hit hit = camera_hit(nodes, leaves, triangles, ray);
  float passed = 0.0f;
  while (hit.id != k_none && is_camera_invisible(triangles, hit.id)) {
    // On from just behind the surface: a few ulps of all that was passed.
    const float step = hit.t + 1e-6f * (passed + hit.t);
    passed += step;
    for (int axis = 0; axis < 3; ++axis)
      ray.origin[axis] = fma(step, ray.direction[axis], ray.origin[axis]);
    hit = camera_hit(nodes, leaves, triangles, ray);
  }
  const bool met = hit.id != k_none;
  objects[i] = met ? as_uint(triangles[hit.id * k_triangle_words + k_triangle_object]) : k_none;
  depths[i] = met ? view->start_depth + (passed + hit.t) : 0.0f;
}
