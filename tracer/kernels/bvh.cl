// SPDX-License-Identifier: Apache-2.0
// Rays against the 8-wide tree of types.h. One ray walks the tree; the boxes of a node and the
// triangles of a leaf are tested together in one vector.
//
// The nearest hit is the least (t, id) over all triangles, whatever the tree: a triangle's t
// depends on ray and triangle alone, and no box is skipped that could hold it. Three errors must be
// covered for that. Boxes are compared as fma(plane, 1/d, -o/d); the product o/d is wrong by half
// an ulp, and the triangle test by a few ulps of the distances it works with, so both ends of every
// slab are moved outwards by k_slab_error (|o| + reach) / |d| (a constant of the ray: it costs
// nothing a node). 1/d itself is wrong by half an ulp: relative, so the far end is scaled by
// k_far_scale.
#pragma once

#include "tracer/kernels/types.h"

#define k_slab_error 9.5367431640625e-7f /* 16 ulps */
#define k_far_scale 1.0000005f
#define k_leaf_bit 0x80000000u

typedef struct {
  float t;       ///< distance in lengths of the direction, or the ray's reach where nothing is hit
  float b1, b2;  ///< barycentric weights of corners 1 and 2
  uint id;       ///< triangle, or k_none
} Hit;

typedef struct {
  float origin[3], direction[3];
  float t_max;
} Ray;

// The eight answers of a comparison as one integer that is walked bit by bit.
#ifdef __AVX__
typedef uint LaneSet;
DS_FN LaneSet lanes_set(int8 m) {
  return (uint)__builtin_ia32_movmskps256(as_float8(m));
}
DS_FN int first_lane(LaneSet s) {
  return __builtin_ctz(s);
}
DS_FN LaneSet without_first(LaneSet s) {
  return s & (s - 1u);
}
#else
typedef ulong LaneSet;
DS_FN LaneSet lanes_set(int8 m) {
  return as_ulong(convert_char8(m)) & 0x8080808080808080ul;
}
DS_FN int first_lane(LaneSet s) {
  return (63 - (int)clz(s & (0ul - s))) >> 3;
}
DS_FN LaneSet without_first(LaneSet s) {
  return s & (s - 1ul);
}
#endif

DS_FN float8 lesser8(float8 a, float8 b) {
  return a < b ? a : b;
}
DS_FN float8 greater8(float8 a, float8 b) {
  return a > b ? a : b;
}
DS_FN float least_of(float8 a) {
  const float4 b = a.lo < a.hi ? a.lo : a.hi;
  const float2 c = b.lo < b.hi ? b.lo : b.hi;
  return c.x < c.y ? c.x : c.y;
}

/// What box tests need of a ray, by axis.
typedef struct {
  float inverse[3];
  float near_offset[3], far_offset[3];
  int near_plane[3];  ///< vector of a node that holds the plane met first
} SlabRay;

DS_FN SlabRay slab_ray(const Ray* ray, float reach) {
  SlabRay s;
  const float origin_reach =
      fmax(fabs(ray->origin[0]), fmax(fabs(ray->origin[1]), fabs(ray->origin[2])));
  const float margin = k_slab_error * (origin_reach + reach);
  for (int axis = 0; axis < 3; ++axis) {
    const float d = ray->direction[axis];
    const float divisor = fabs(d) < 1e-18f ? copysign(1e-18f, d) : d;
    const float inverse = 1.0f / divisor;
    const float offset = -ray->origin[axis] * inverse;
    const float widen = margin * fabs(inverse);
    s.inverse[axis] = inverse;
    s.near_offset[axis] = offset - widen;
    s.far_offset[axis] = offset + widen;
    s.near_plane[axis] = 2 * axis + (inverse < 0.0f ? 1 : 0);
  }
  return s;
}

/// Entry distances of the eight children; `*open` tells which are met before t_max.
DS_FN float8 test_boxes(const __global float8* node, const SlabRay* s, float t_max, LaneSet* open) {
  const float8 near_x =
      fma(node[s->near_plane[0]], (float8)(s->inverse[0]), (float8)(s->near_offset[0]));
  const float8 near_y =
      fma(node[s->near_plane[1]], (float8)(s->inverse[1]), (float8)(s->near_offset[1]));
  const float8 near_z =
      fma(node[s->near_plane[2]], (float8)(s->inverse[2]), (float8)(s->near_offset[2]));
  const float8 far_x =
      fma(node[s->near_plane[0] ^ 1], (float8)(s->inverse[0]), (float8)(s->far_offset[0]));
  const float8 far_y =
      fma(node[s->near_plane[1] ^ 1], (float8)(s->inverse[1]), (float8)(s->far_offset[1]));
  const float8 far_z =
      fma(node[s->near_plane[2] ^ 1], (float8)(s->inverse[2]), (float8)(s->far_offset[2]));
  const float8 entry = greater8(greater8(near_x, near_y), greater8(near_z, (float8)(0.0f)));
  const float8 leave =
      lesser8(lesser8(far_x, far_y), lesser8(far_z, (float8)(t_max))) * k_far_scale;
  *open = lanes_set(entry <= leave);
  return entry;
}

/// Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection": the ray is sheared onto its
/// longest axis.
typedef struct {
  int x, y, z;  ///< axes; z is the direction's longest
  float shear_x, shear_y, shear_z;
} ShearRay;

DS_FN ShearRay shear_ray(const Ray* ray) {
  const float* d = ray->direction;
  ShearRay s;
  s.z = fabs(d[0]) > fabs(d[1]) ? (fabs(d[0]) > fabs(d[2]) ? 0 : 2)
                                : (fabs(d[1]) > fabs(d[2]) ? 1 : 2);
  s.x = s.z == 2 ? 0 : s.z + 1;
  s.y = s.x == 2 ? 0 : s.x + 1;
  s.shear_z = 1.0f / d[s.z];
  s.shear_x = d[s.x] * s.shear_z;
  s.shear_y = d[s.y] * s.shear_z;
  return s;
}

/// What a leaf's eight triangles answer. An edge's function is a difference of two products, each
/// rounded: swapping its ends negates it exactly, so two triangles never both miss a ray through
/// their common edge. No fma there for that reason. `t` is a mean of corner depths with weights of
/// one sign, so it is right to a few ulps even for slivers.
typedef struct {
  float8 t, weight1, weight2, inverse_sum;
  LaneSet hits;
} LeafHits;

DS_FN LeafHits test_leaf(const __global float8* leaf, const Ray* ray, const ShearRay* s,
                         float t_max) {
  const float8 ox = (float8)(ray->origin[s->x]);
  const float8 oy = (float8)(ray->origin[s->y]);
  const float8 oz = (float8)(ray->origin[s->z]);
  const float8 shear_x = (float8)(-s->shear_x);
  const float8 shear_y = (float8)(-s->shear_y);
  const float8 az = leaf[s->z] - oz;
  const float8 bz = leaf[3 + s->z] - oz;
  const float8 cz = leaf[6 + s->z] - oz;
  const float8 ax = fma(shear_x, az, leaf[s->x] - ox);
  const float8 ay = fma(shear_y, az, leaf[s->y] - oy);
  const float8 bx = fma(shear_x, bz, leaf[3 + s->x] - ox);
  const float8 by = fma(shear_y, bz, leaf[3 + s->y] - oy);
  const float8 cx = fma(shear_x, cz, leaf[6 + s->x] - ox);
  const float8 cy = fma(shear_y, cz, leaf[6 + s->y] - oy);
  const float8 u = cx * by - cy * bx;
  const float8 v = ax * cy - ay * cx;
  const float8 w = bx * ay - by * ax;
  const float8 sum = u + v + w;
  LeafHits hits;
  hits.inverse_sum = 1.0f / sum;
  hits.t = fma(u, az, fma(v, bz, w * cz)) * s->shear_z * hits.inverse_sum;
  hits.weight1 = v;
  hits.weight2 = w;
  const int8 inside =
      ((u >= 0.0f) & (v >= 0.0f) & (w >= 0.0f)) | ((u <= 0.0f) & (v <= 0.0f) & (w <= 0.0f));
  hits.hits = lanes_set(inside & (sum != 0.0f) & (hits.t > 0.0f) & (hits.t <= t_max));
  return hits;
}

/// Takes the leaf's nearest triangle where it is nearer than `hit`, or as near and of a lesser id.
DS_FN void nearest_in_leaf(const __global float8* leaf, const Ray* ray, const ShearRay* s,
                           Hit* hit) {
  const LeafHits found = test_leaf(leaf, ray, s, hit->t);
  LaneSet left = found.hits;
  if (!left) return;
  float t[k_bvh_width], weight1[k_bvh_width], weight2[k_bvh_width], inverse_sum[k_bvh_width];
  vstore8(found.t, 0, t);
  vstore8(found.weight1, 0, weight1);
  vstore8(found.weight2, 0, weight2);
  vstore8(found.inverse_sum, 0, inverse_sum);
  const __global uint* ids = (const __global uint*)(leaf + k_leaf_ids);
  do {
    const int i = first_lane(left);
    left = without_first(left);
    if (t[i] < hit->t || (t[i] == hit->t && ids[i] < hit->id)) {
      hit->t = t[i];
      hit->b1 = weight1[i] * inverse_sum[i];
      hit->b2 = weight2[i] * inverse_sum[i];
      hit->id = ids[i];
    }
  } while (left);
}

/// Nodes still to visit, nearest on top.
typedef struct {
  uint node[k_bvh_stack];
  float entry[k_bvh_stack];
} Stack;

/// Pushes the open children (two at least) but the nearest, which is returned, so that the next
/// nearest is on top. `*size` is the stack's height; a plain variable, so that it stays in a
/// register.
DS_FN uint push_open(Stack* stack, int* size, const __global float8* node, float8 entries,
                     LaneSet open) {
  float entry[k_bvh_width];
  vstore8(entries, 0, entry);
  const __global uint* child = (const __global uint*)(node + k_node_children);
  int nearest = first_lane(open);
  open = without_first(open);
  const int base = *size;
  int top = base;
  do {
    int i = first_lane(open);
    open = without_first(open);
    if (entry[i] < entry[nearest]) {
      const int nearer = i;
      i = nearest;
      nearest = nearer;
    }
    int at = top++;
    for (; at > base && stack->entry[at - 1] < entry[i]; --at) {
      stack->entry[at] = stack->entry[at - 1];
      stack->node[at] = stack->node[at - 1];
    }
    stack->entry[at] = entry[i];
    stack->node[at] = child[i];
  } while (open);
  *size = top;
  return child[nearest];
}

/// The nearest hit in (0, t_max].
static Hit nearest_hit(const __global float8* nodes, const __global float8* leaves, float reach,
                       Ray ray) {
  const SlabRay slab = slab_ray(&ray, reach);
  const ShearRay shear = shear_ray(&ray);
  Hit hit;
  hit.t = ray.t_max;
  hit.b1 = hit.b2 = 0.0f;
  hit.id = k_none;
  Stack stack;
  int size = 0;
  uint current = 0;
  for (;;) {
    while (!(current & k_leaf_bit)) {
      const __global float8* node = nodes + current * k_node_vectors;
      LaneSet open;
      const float8 entries = test_boxes(node, &slab, hit.t, &open);
      if (!open) goto next;
      if (without_first(open)) {
        current = push_open(&stack, &size, node, entries, open);
      } else {
        current = ((const __global uint*)(node + k_node_children))[first_lane(open)];
      }
    }
    nearest_in_leaf(leaves + (current & ~k_leaf_bit) * k_leaf_vectors, &ray, &shear, &hit);
  next:
    // What entered the stack behind the hit found since is not visited; equal distances are, for
    // the lesser id.
    do {
      if (size == 0) return hit;
      --size;
    } while (stack.entry[size] > hit.t * k_far_scale);
    current = stack.node[size];
  }
}

/// True where anything is hit in (0, t_max].
static bool any_hit(const __global float8* nodes, const __global float8* leaves, float reach,
                    Ray ray) {
  const SlabRay slab = slab_ray(&ray, reach);
  const ShearRay shear = shear_ray(&ray);
  uint stack[k_bvh_stack];
  int size = 0;
  uint current = 0;
  for (;;) {
    while (!(current & k_leaf_bit)) {
      const __global float8* node = nodes + current * k_node_vectors;
      LaneSet open;
      test_boxes(node, &slab, ray.t_max, &open);
      if (!open) goto next;
      const __global uint* child = (const __global uint*)(node + k_node_children);
      current = child[first_lane(open)];
      for (open = without_first(open); open; open = without_first(open)) {
        stack[size++] = child[first_lane(open)];
      }
    }
    if (test_leaf(leaves + (current & ~k_leaf_bit) * k_leaf_vectors, &ray, &shear, ray.t_max).hits)
      return true;
  next:
    if (size == 0) return false;
    current = stack[--size];
  }
}
