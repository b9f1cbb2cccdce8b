// SPDX-License-Identifier: Apache-2.0
// The planes of a picture that ask no light: one ray a pixel, through its centre and the pinhole.
// DS_PLANES(X) is the list of those asked for, X(name, numbers a pixel of those before it)
// (device/plane_types.cc writes it).
#include "tracer/kernels/hits.cl"
#include "tracer/kernels/plane.h"
#include "tracer/kernels/ties.cl"
#include "tracer/kernels/view_data.h"
#ifdef DS_HOOK_ALBEDO
#  include "tracer/kernels/albedo.h"
#endif

DS_FN bool is_camera_invisible(DS_GLOBAL float* triangles, uint id) {
  const uint flags = as_uint(triangles[id * k_triangle_words + k_triangle_flags]);
  return (flags & k_flag_camera_invisible) != 0;
}

DS_FN Hit camera_hit(const __global float8* nodes, const __global float8* leaves,
                     DS_GLOBAL float* triangles, Ray ray) {
  const Hit hit = nearest_hit(nodes, leaves, ray);
  if (hit.id == k_none || !may_yield(tie_flags(triangles, hit.id), true)) return hit;
  return top_hit(nodes, leaves, triangles, ray, hit, true);
}

/// The ray through pixel i. Its direction's part along the viewing axis is 1, so a hit's distance in
/// lengths of it is the planar depth.
DS_FN Ray pixel_ray(const __global ViewData* view, uint i) {
  const float sx = 2.0f * ((float)(i % view->width) + 0.5f) / (float)view->width - 1.0f;
  const float sy = 1.0f - 2.0f * ((float)(i / view->width) + 0.5f) / (float)view->height;
  Ray ray;
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] =
        fma(sx, view->start_right[axis], fma(sy, view->start_up[axis], view->start[axis]));
    ray.direction[axis] = fma(sx, view->right[axis], fma(sy, view->up[axis], view->forward[axis]));
  }
  ray.t_max = 1e30f;
  return ray;
}

/// planes: all numbers of the first plane, pixel by pixel, then those of the next. material_ids: by
/// the material's row.
__kernel void trace_planes(
    const __global float8* restrict nodes, const __global float8* restrict leaves,
    const __global float* restrict triangles, const __global uint* restrict material_ids,
    const __global ViewData* restrict view, __global float* restrict planes
#ifdef DS_HOOK_ALBEDO
    ,
    const __global float* restrict materials, const __global float* restrict programs,
    const __global float* restrict tables, const __global SceneData* restrict scene_data
#endif
) {
  const uint i = get_global_id(0);
  const uint pixels = view->width * view->height;
  if (i >= pixels) return;
  Ray ray = pixel_ray(view, i);
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
  HitPoint h;
  h.object = h.material_id = 0u;
  h.depth = h.distance = 0.0f;
  if (met) {
    const real3 direction = vec(ray.direction[0], ray.direction[1], ray.direction[2]);
    h.depth = view->start_depth + (passed + hit.t);
    h.distance = h.depth * sqrt(dot(direction, direction));
    h.object = as_uint(triangles[hit.id * k_triangle_words + k_triangle_object]);
#ifdef DS_PLANE_MATERIAL_IDS
    h.material_id =
        material_ids[as_uint(triangles[hit.id * k_triangle_words + k_triangle_material])];
#endif
#ifdef DS_PLANE_SURFACE
    BatchHits found;
    found.t[0] = hit.t;
    found.id[0] = hit.id;
    LaneHits hits;
    load_triangles(triangles, &found, &hits);
    const real3 origin = vec(ray.origin[0], ray.origin[1], ray.origin[2]);
    h.surface = surface_of(&hits, origin, unit(direction));
#endif
#ifdef DS_HOOK_ALBEDO
    h.surface.colors = hit.id + 1u;
    MaterialTables t;
    t.materials = materials;
    t.programs = programs;
    t.tables = tables;
    t.material_words = scene_data->material_words;
    h.albedo = surface_albedo(
        t, as_uint(triangles[hit.id * k_triangle_words + k_triangle_material]), &h.surface);
#endif
  }
#define DS_PLANE(name, before)                                                       \
  {                                                                                  \
    real out[name##_width];                                                          \
    if (met) name##_at(&h, out);                                                     \
    for (uint k = 0; k < (uint)name##_width; ++k)                                    \
      planes[before##u * pixels + i * (uint)name##_width + k] = met ? out[k] : 0.0f; \
  }
  DS_PLANES(DS_PLANE)
}
