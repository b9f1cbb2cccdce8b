// SPDX-License-Identifier: Apache-2.0
// Paths among surfaces that are tied with each other (ties.cl): what a ray met yields to what lies on
// it, and a path that leaves one of them goes to the next before it goes anywhere else.
#pragma once

#include "tracer/kernels/scatter.cl"

/// The lanes' surface points among those tied with others.
typedef struct {
  natural flags;  ///< of the triangle
  mask inside;    ///< reached from one tied with it, not from afar
  mask rises;     ///< and from below
} Ties;

/// Lets nearest hits yield to those that lie on them. True where any did.
DS_FN bool settle_ties(const SceneTables* t, const SceneData* scene, const Paths* paths,
                       const LaneRays* rays, mask asks, natural flags, BatchHits* found) {
  const mask camera = paths->vertices == 0u;
  mask wanted = asks & ((flags & (uint)k_flag_covered) != 0u);
#ifdef DS_CAMERA_INVISIBLE
  wanted = wanted | (asks & camera & ((flags & (uint)k_flag_camera_invisible) != 0u) &
                     ((flags & (uint)k_flags_tied) != 0u));
#endif
  if (!any_lane(wanted)) return false;
  const real3 at = add_scaled(rays->origin, rays->direction, *(const real*)found->t);
  wanted = wanted & may_tie_at(scene, at);
  return any_lane(wanted) &&
         top_hits(t->nodes, t->leaves, t->triangles, rays, wanted, camera, found);
}

/// Where a direction that leaves a tied surface may meet the next one tied with it: from one reached
/// from afar only through it, since nothing lies on that. `*rises`: the next above, not below.
DS_FN mask may_meet_layer(const Ties* ties, mask through, mask* rises) {
  *rises = choose_mask(through, ties->rises, !ties->rises);
  const mask up = ties->inside & *rises & ((ties->flags & (uint)k_flag_covered) != 0u);
  return up | (!*rises & ((ties->flags & (uint)k_flag_covers) != 0u));
}

/// Sends paths of `active` that have left a tied surface by their new direction on to the next.
DS_FN void ask_for_layer(Paths* paths, mask active, const Ties* ties, const Surface* s,
                         natural id) {
  const mask through = dot(paths->direction, s->normal) < 0.0f;
  const mask may = may_meet_layer(ties, through, &paths->rises);
  paths->layer = choose_natural(active & may, id, paths->layer);
}

#ifdef DS_LIGHTS_SAMPLED
/// Lets no shadow ray out that a surface tied with its origin's stands before.
DS_FN void shade_by_ties(Paths* paths, const SceneTables* t, const Ties* ties, const Surface* s,
                         natural id) {
#  ifdef DS_TRANSMITS
  const mask through = dot(paths->shadow.direction, s->normal) < 0.0f;
  mask rises;
  const mask asks = paths->shadow.wanted & may_meet_layer(ties, through, &rises);
  if (any_lane(asks))
    paths->shadow.wanted =
        paths->shadow.wanted & (next_layers(t->nodes, t->leaves, t->triangles, paths->shadow.origin,
                                            id, rises, asks) == k_none);
#  else
  // What the path came through stands before every light on that side.
  paths->shadow.wanted = paths->shadow.wanted & !ties->inside;
#  endif
}
#endif
