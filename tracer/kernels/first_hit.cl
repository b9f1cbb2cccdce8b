// SPDX-License-Identifier: Apache-2.0
// The planes of a picture that ask no light: one ray a pixel, through its centre and the pinhole, the
// rays of a tile of DS_LANES pixels together. DS_PLANES(X) is the list of those asked for, X(name, numbers a
// pixel of those before it) (device/plane_types.cc writes it).
#include "tracer/kernels/hits.cl"
#include "tracer/kernels/packet.cl"
#include "tracer/kernels/plane.h"
#include "tracer/kernels/tied_lanes.cl"
#include "tracer/kernels/view_data.h"
#ifdef DS_HOOK_ALBEDO
#  include "tracer/kernels/albedo.h"
#endif

/// A word of the triangles' rows; of the first triangle's where the lane met none.
DS_FN natural triangle_word(DS_GLOBAL float* triangles, natural id, uint word) {
  const natural row = choose_natural(id == k_none, (natural)(0u), id);
  return load_natural(triangles, row * (uint)k_triangle_words + word);
}

/// trace_lanes without any shadow rays.
#if DS_LANES == 1
DS_FN void nearest_lanes(const __global float8* nodes, const __global float8* leaves,
                         const LaneRays* rays, BatchHits* found) {
  LaneRays none = *rays;
  none.wanted = (mask)(0);
  trace_lanes(nodes, leaves, rays, &none, found);
}
#else
DS_FN void nearest_lanes(const __global float8* nodes, const __global float8* leaves,
                         const LaneRays* rays, BatchHits* found) {
  Batch b;
  Counts n = {0, 0, 0};
  n.at_node = add_rays(&b, 0, 0, nodes, rays);
  const mask wanted = rays->wanted & traceable_lanes(rays);
  if (n.at_node != 0 && keep_together(&b, wanted) && trace_packet(&b, wanted, nodes, leaves))
    n.at_node = 0;
  while ((n.at_node | n.at_leaf | n.climbing) != 0) {
    n = step_nodes(&b, n, nodes);
    n = step_leaves(&b, n, leaves);
    n = step_climbing(&b, n, nodes);
  }
  *(real*)found->t = *(const real*)&b.t[0];
  *(natural*)found->id = *(const natural*)&b.id[0];
}
#endif

/// What the wanted rays meet first. Those that the camera does not see are there still.
DS_FN void camera_hits(const __global float8* nodes, const __global float8* leaves,
                       DS_GLOBAL float* triangles, const SceneData* scene, const LaneRays* rays,
                       BatchHits* found) {
  nearest_lanes(nodes, leaves, rays, found);
  const natural id = *(const natural*)found->id;
  const natural flags = triangle_word(triangles, id, k_triangle_flags);
  // As may_yield of ties.cl.
  const mask unseen = (flags & (uint)k_flag_camera_invisible) != 0u;
  mask asks =
      rays->wanted & (id != k_none) &
      (((flags & (uint)k_flag_covered) != 0u) | (unseen & ((flags & (uint)k_flags_tied) != 0u)));
  if (!any_lane(asks)) return;
  asks =
      asks & may_tie_at(scene, add_scaled(rays->origin, rays->direction, *(const real*)found->t));
  if (any_lane(asks)) top_hits(nodes, leaves, triangles, rays, asks, (mask)(-1), found);
}

DS_FN real along(const float* start, const float* right, const float* up, int axis, real sx,
                 real sy) {
  return fma(sx, (real)(right[axis]), fma(sy, (real)(up[axis]), (real)(start[axis])));
}

/// The rays through pixels (x, y). Their directions' part along the viewing axis is 1, so a hit's
/// distance in lengths of it is the planar depth.
DS_FN LaneRays pixel_rays(const ViewData* view, natural x, natural y) {
  const real sx = 2.0f * (to_real(x) + 0.5f) / (float)view->width - 1.0f;
  const real sy = 1.0f - 2.0f * (to_real(y) + 0.5f) / (float)view->height;
  LaneRays rays;
  rays.origin = vec(along(view->start, view->start_right, view->start_up, 0, sx, sy),
                    along(view->start, view->start_right, view->start_up, 1, sx, sy),
                    along(view->start, view->start_right, view->start_up, 2, sx, sy));
  rays.direction = vec(along(view->forward, view->right, view->up, 0, sx, sy),
                       along(view->forward, view->right, view->up, 1, sx, sy),
                       along(view->forward, view->right, view->up, 2, sx, sy));
  rays.t_max = (real)(1e30f);
  rays.wanted = (x < view->width) & (y < view->height);
  return rays;
}

/// Number k of `width` of the tile's pixels, whose first is (x, y).
DS_FN void store_number(__global float* plane, const ViewData* view, uint x, uint y, uint width,
                        uint k, real number) {
  float lanes[DS_LANES] __attribute__((aligned(64)));
  *(real*)lanes = number;
  const uint across = tile_width(DS_LANES);
  const uint rows = min(view->height - y, tile_height(DS_LANES));
  const uint columns = min(view->width - x, across);
  for (uint row = 0; row < rows; ++row)
    for (uint column = 0; column < columns; ++column)
      plane[((y + row) * view->width + x + column) * width + k] = lanes[row * across + column];
}

/// planes: all numbers of the first plane, pixel by pixel, then those of the next. material_ids: by
/// the material's row.
__kernel void trace_planes(
    const __global float8* restrict nodes, const __global float8* restrict leaves,
    const __global float* restrict triangles, const __global float* restrict material_ids,
    const __global ViewData* restrict view_data, const __global SceneData* restrict scene_data,
    __global float* restrict planes
#ifdef DS_HOOK_ALBEDO
    ,
    const __global float* restrict materials, const __global float* restrict programs,
    const __global float* restrict tables
#endif
) {
  const ViewData view = *view_data;
  const SceneData scene = *scene_data;
  const uint across = tile_width(DS_LANES);
  const uint tiles = (view.width + across - 1u) / across;
  const uint x = (uint)get_global_id(0) % tiles * across;
  const uint y = (uint)get_global_id(0) / tiles * tile_height(DS_LANES);
  if (y >= view.height) return;
  const uint pixels = view.width * view.height;
  LaneRays rays = pixel_rays(&view, DS_LANE_NUMBERS % across + x, DS_LANE_NUMBERS / across + y);
  BatchHits found;
  camera_hits(nodes, leaves, triangles, &scene, &rays, &found);
  real t = *(const real*)found.t;
  natural id = *(const natural*)found.id;
  real passed = (real)(0.0f);
  for (;;) {
    const natural flags = triangle_word(triangles, id, k_triangle_flags);
    rays.wanted = rays.wanted & (id != k_none) & ((flags & (uint)k_flag_camera_invisible) != 0u);
    if (!any_lane(rays.wanted)) break;
    // On from just behind the surface: a few ulps of all that was passed.
    const real step = t + 1e-6f * (passed + t);
    passed = choose(rays.wanted, passed + step, passed);
    rays.origin = choose(rays.wanted, add_scaled(rays.origin, rays.direction, step), rays.origin);
    camera_hits(nodes, leaves, triangles, &scene, &rays, &found);
    t = choose(rays.wanted, *(const real*)found.t, t);
    id = choose_natural(rays.wanted, *(const natural*)found.id, id);
  }
  const mask met = id != k_none;
  const real zero = (real)(0.0f);
  const natural nothing = (natural)(0u);
  HitPoint h;
  h.depth = choose(met, view.start_depth + (passed + t), zero);
  h.distance = h.depth * sqrt(dot(rays.direction, rays.direction));
  h.object = choose_natural(met, triangle_word(triangles, id, k_triangle_object), nothing);
  h.material_id = nothing;
#ifdef DS_PLANE_MATERIAL_IDS
  const natural material = triangle_word(triangles, id, k_triangle_material);
  h.material_id = choose_natural(met, load_natural(material_ids, material), nothing);
#endif
#ifdef DS_PLANE_SURFACE
  *(natural*)found.id = id;
  LaneHits hits;
  load_triangles(triangles, &found, &hits);
  h.surface = surface_of(&hits, rays.origin, unit(rays.direction));
#endif
#ifdef DS_HOOK_ALBEDO
  h.surface.colors = id + 1u;
  MaterialTables tables_of;
  tables_of.materials = materials;
  tables_of.programs = programs;
  tables_of.tables = tables;
  tables_of.material_words = scene.material_words;
  h.albedo =
      surface_albedo(tables_of, triangle_word(triangles, id, k_triangle_material), met, &h.surface);
#endif
#define DS_PLANE(name, before)                                                      \
  {                                                                                 \
    real out[name##_width];                                                         \
    name##_at(&h, out);                                                             \
    for (uint k = 0; k < (uint)name##_width; ++k)                                   \
      store_number(planes + before##u * pixels, &view, x, y, (uint)name##_width, k, \
                   choose(met, out[k], zero));                                      \
  }
  DS_PLANES(DS_PLANE)
}
