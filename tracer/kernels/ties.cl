// SPDX-License-Identifier: Apache-2.0
// Surfaces of two objects in one plane, such as a model's level foot and the floor. Which of them a
// ray meets first is a matter of rounding; a rule decides instead: as if the object of greater rank
// lay infinitesimally lower, seen from where the ray comes. Ranks and the triangles that can tie at
// all are the host's (device/ties.cc); other triangles are not concerned, and ask for nothing.
//
// - A ray that meets a covered triangle goes on through what rounding cannot tell from it, and
//   meets the triangle of least rank there (top_hit).
// - A path that leaves a surface through it, or back from one that it reached in this way, meets
//   the next one below or above at once, at the point where it is (next_layer): light gets through
//   a glass body's foot to the floor, and back.
//
// Both ask for the least or greatest (rank, id) of a set that ray and scene define, so the answer
// does not depend on the tree.
#pragma once

#include "tracer/kernels/bvh.cl"

/// What is taken: the least rank below the first triangle's, the greatest below it, the least
/// above.
enum { k_tie_top, k_tie_up, k_tie_down };

/// Cosine of the greatest angle between tied triangles. Surfaces at a greater one tie in a strip
/// too narrow to be seen.
#define k_tie_cosine 0.999f

/// A triangle's unit normal; zero where it has no area.
DS_FN void tie_normal(DS_GLOBAL float* row, float* n) {
  float e1[3], e2[3];
  float size = 1e-37f;
  for (int axis = 0; axis < 3; ++axis) {
    e1[axis] = row[3 + axis] - row[axis];
    e2[axis] = row[6 + axis] - row[axis];
    size = fmax(size, fmax(fabs(e1[axis]), fabs(e2[axis])));
  }
  const float s = 1.0f / size;
  for (int axis = 0; axis < 3; ++axis) {
    e1[axis] *= s;
    e2[axis] *= s;
  }
  n[0] = e1[1] * e2[2] - e1[2] * e2[1];
  n[1] = e1[2] * e2[0] - e1[0] * e2[2];
  n[2] = e1[0] * e2[1] - e1[1] * e2[0];
  const float inverse = 1.0f / sqrt(fmax(fma(n[0], n[0], fma(n[1], n[1], n[2] * n[2])), 1e-30f));
  for (int axis = 0; axis < 3; ++axis)
    n[axis] *= inverse;
}

DS_FN float tie_dot(const float* a, const float* b) {
  return fma(a[0], b[0], fma(a[1], b[1], a[2] * b[2]));
}

/// The triangle that others are compared with.
typedef struct {
  float normal[3];
  float error;  ///< of itself and all that tie with it: position_error of surface.h
  uint rank;
  bool unseen;  ///< by this ray
} TieFrom;

DS_FN uint tie_flags(DS_GLOBAL float* triangles, uint id) {
  return as_uint(triangles[id * k_triangle_words + k_triangle_flags]);
}

DS_FN TieFrom tie_from(DS_GLOBAL float* triangles, uint id, bool camera) {
  const uint flags = tie_flags(triangles, id);
  TieFrom from;
  tie_normal(triangles + id * k_triangle_words, from.normal);
  from.error = as_float(((flags >> k_tie_error_shift) & 0xffu) << 23);
  from.rank = flags >> k_tie_rank_shift;
  from.unseen = camera && (flags & k_flag_camera_invisible) != 0;
  return from;
}

/// Whether a triangle is of the kind asked for, and before the best so far.
DS_FN bool takes_tie(const TieFrom* from, DS_GLOBAL float* triangles, uint id, int which,
                     bool camera, uint best_id, uint best_rank) {
  const uint flags = tie_flags(triangles, id);
  const uint rank = flags >> k_tie_rank_shift;
  if ((flags & k_flags_tied) == 0 || rank == from->rank) return false;
  if (camera && (flags & k_flag_camera_invisible) != 0) return false;
  if (!from->unseen && (rank > from->rank) != (which == k_tie_down)) return false;
  if (best_id != k_none) {
    if (rank == best_rank ? id >= best_id : (rank > best_rank) != (which == k_tie_up)) return false;
  }
  float normal[3];
  tie_normal(triangles + id * k_triangle_words, normal);
  return fabs(tie_dot(from->normal, normal)) >= k_tie_cosine;
}

/// Of the tied triangles that the ray meets in [t_min, ray.t_max], the one asked for; its id is
/// k_none where there is none.
DS_OUT_OF_LINE Hit tied_hit(const __global float8* nodes, const __global float8* leaves,
                            DS_GLOBAL float* triangles, const Ray* ray, float t_min,
                            const TieFrom* from, int which, bool camera) {
  Hit hit;
  hit.t = hit.b1 = hit.b2 = 0.0f;
  hit.id = k_none;
  uint rank = 0;
  if (!is_traceable(ray)) return hit;
  const SlabRay slab = slab_ray(nodes, ray);
  const ShearRay shear = shear_ray(ray, slab.inverse);
  uint stack[k_bvh_stack];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const uint current = stack[--size];
    if (!(current & k_leaf_bit)) {
      const __global float8* node = nodes + current * k_node_vectors;
      const __global uint* child = (const __global uint*)(node + k_node_children);
      LaneSet open;
      test_boxes(node, &slab, t_min, ray->t_max, &open);
      for (; open; open = without_first(open))
        stack[size++] = child[first_lane(open)];
      continue;
    }
    const __global float8* leaf = leaves + (current & ~k_leaf_bit) * k_leaf_vectors;
    const LeafTest found = test_leaf(leaf, ray, &shear, ray->t_max);
    LaneSet left = lanes_set(found.met & (found.t >= t_min));
    if (!left) continue;
    float t[k_bvh_width], weight1[k_bvh_width], weight2[k_bvh_width], inverse_sum[k_bvh_width];
    vstore8(found.t, 0, t);
    vstore8(found.weight1, 0, weight1);
    vstore8(found.weight2, 0, weight2);
    vstore8(found.inverse_sum, 0, inverse_sum);
    const __global uint* ids = (const __global uint*)(leaf + k_leaf_ids);
    for (; left; left = without_first(left)) {
      const int i = first_lane(left);
      if (!takes_tie(from, triangles, ids[i], which, camera, hit.id, rank)) continue;
      hit.t = t[i];
      hit.b1 = weight1[i] * inverse_sum[i];
      hit.b2 = weight2[i] * inverse_sum[i];
      hit.id = ids[i];
      rank = tie_flags(triangles, hit.id) >> k_tie_rank_shift;
    }
  }
  return hit;
}

/// Whether a nearest hit may have to yield to another: it is covered, or a camera's ray does not
/// see it.
DS_FN bool may_yield(uint flags, bool camera) {
  const bool unseen = camera && (flags & k_flag_camera_invisible) != 0;
  return (flags & (unseen ? (uint)k_flags_tied : (uint)k_flag_covered)) != 0;
}

/// What a ray meets whose nearest hit is `hit`, of a triangle that may yield. Hits are off their
/// planes by 4 half-ulps of distance and extent (bvh.cl), and tied triangles off each other by
/// twice the error: the rest of the window is a margin. Fast arithmetic may find some before the
/// nearest.
DS_FN Hit top_hit(const __global float8* nodes, const __global float8* leaves,
                  DS_GLOBAL float* triangles, Ray ray, Hit hit, bool camera) {
  const TieFrom from = tie_from(triangles, hit.id, camera);
  const float length = fabs(ray.direction[0]) + fabs(ray.direction[1]) + fabs(ray.direction[2]);
  const float window = fma(5e-7f * length, hit.t, 4.0f * from.error);
  const float reach = window / fmax(fabs(tie_dot(from.normal, ray.direction)), 1e-9f);
  ray.t_max = hit.t + reach;
  const float t_min = fmax(hit.t - reach, 0.0f);
  const Hit top = tied_hit(nodes, leaves, triangles, &ray, t_min, &from, k_tie_top, camera);
  return top.id != k_none ? top : hit;
}

/// The triangle next above (`rises`) or below `id` where a ray leaves it, or k_none. `origin` is
/// the ray's: on one side of the triangle or the other, off by up to 3.5 errors, and what ties with
/// it may be off by 3.
DS_FN uint next_layer(const __global float8* nodes, const __global float8* leaves,
                      DS_GLOBAL float* triangles, const float* origin, uint id, bool rises) {
  const TieFrom from = tie_from(triangles, id, false);
  const float reach = 8.0f * from.error;
  Ray ray;
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = fma(reach, from.normal[axis], origin[axis]);
    ray.direction[axis] = -from.normal[axis];
  }
  ray.t_max = 2.0f * reach;
  return tied_hit(nodes, leaves, triangles, &ray, 0.0f, &from, rises ? k_tie_up : k_tie_down, false)
      .id;
}
