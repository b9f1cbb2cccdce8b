// SPDX-License-Identifier: Apache-2.0
// Rays against the 8-wide tree of scene_data.h. One ray walks the tree; the boxes of a node and the
// triangles of a leaf are tested together in one vector.
//
// The nearest hit is the least (t, id) over all triangles, whatever the tree: a triangle's t
// depends on ray and triangle alone, and no box is skipped that could hold it. The errors that must
// be covered for that, in units of half an ulp of the lengths named:
//   - boxes are compared as fma(plane, 1/d, -o/d): 1 |o| for the product, 2 of the box's distance
//     for 1/d and its use, 1 of it for the comparison of two rounded distances;
//   - the triangle test misplaces a corner by 4 of its distance from the origin, which is at most
//     the hit's distance and the triangle's own extent.
// The extent's part is added to the boxes when the tree is built (box_error of
// tracer/accel/binary_tree.cc). For the rest both ends of every slab are moved outwards by
// k_slab_error ((|o| + distance) / |d| + distance), where nothing is hit beyond `distance`:
// constants of the ray, so they cost nothing a node.
#pragma once

#include "tracer/kernels/scene_data.h"

#define k_slab_error 4.76837158203125e-7f /* 8 half-ulps */
/// Below 4 half-ulps of the triangle's farthest corner a hit's distance is within its test's error.
#define k_doubtful_t 2.4e-7f
#define k_leaf_bit 0x80000000u

typedef struct {
  float t;       ///< distance in lengths of the direction, or the ray's t_max where nothing is hit
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

/// What box tests need of a ray, by axis.
typedef struct {
  float inverse[3];
  float near_offset[3], far_offset[3];
  // Offsets in a node, in floats, of the planes met first and last: kept whole, so that a plane's
  // address takes no arithmetic.
  long near_plane[3], far_plane[3];
} SlabRay;

/// Where the ray leaves the scene's bounds, or 0 where it does not meet them: nothing is hit
/// beyond.
DS_FN float leave_scene(const __global float8* nodes, const Ray* ray, const float* inverse) {
  const __global float* bounds = (const __global float*)(nodes + k_root_bounds);
  float leave = ray->t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const float plane = bounds[inverse[axis] < 0.0f ? axis : 3 + axis];
    leave = fmin(leave, (plane - ray->origin[axis]) * inverse[axis]);
  }
  return fmax(leave, 0.0f);
}

DS_FN SlabRay slab_ray(const __global float8* nodes, const Ray* ray) {
  SlabRay s;
  for (int axis = 0; axis < 3; ++axis) {
    const float d = ray->direction[axis];
    s.inverse[axis] = 1.0f / (fabs(d) < 1e-18f ? copysign(1e-18f, d) : d);
    const long first = 2 * axis + (s.inverse[axis] < 0.0f ? 1 : 0);
    s.near_plane[axis] = first * k_bvh_width;
    s.far_plane[axis] = (first ^ 1) * k_bvh_width;
  }
  const float distance = leave_scene(nodes, ray, s.inverse);
  for (int axis = 0; axis < 3; ++axis) {
    const float offset = -ray->origin[axis] * s.inverse[axis];
    const float margin = k_slab_error * (fabs(ray->origin[axis]) + distance);
    const float widen = fma(margin, fabs(s.inverse[axis]), k_slab_error * distance);
    s.near_offset[axis] = offset - widen;
    s.far_offset[axis] = offset + widen;
  }
  return s;
}

/// Entry distances of the eight children; `*open` tells which are met in [t_min, t_max].
DS_FN float8 test_boxes(const __global float8* node, const SlabRay* s, float t_min, float t_max,
                        LaneSet* open) {
  const __global float* planes = (const __global float*)node;
#define DS_PLANE(end, axis) (*(const __global float8*)(planes + s->end##_plane[axis]))
  const float8 near_x =
      fma(DS_PLANE(near, 0), (float8)(s->inverse[0]), (float8)(s->near_offset[0]));
  const float8 near_y =
      fma(DS_PLANE(near, 1), (float8)(s->inverse[1]), (float8)(s->near_offset[1]));
  const float8 near_z =
      fma(DS_PLANE(near, 2), (float8)(s->inverse[2]), (float8)(s->near_offset[2]));
  const float8 far_x = fma(DS_PLANE(far, 0), (float8)(s->inverse[0]), (float8)(s->far_offset[0]));
  const float8 far_y = fma(DS_PLANE(far, 1), (float8)(s->inverse[1]), (float8)(s->far_offset[1]));
  const float8 far_z = fma(DS_PLANE(far, 2), (float8)(s->inverse[2]), (float8)(s->far_offset[2]));
#undef DS_PLANE
  const float8 entry = greater8(greater8(near_x, near_y), greater8(near_z, (float8)(t_min)));
  const float8 leave = lesser8(lesser8(far_x, far_y), lesser8(far_z, (float8)(t_max)));
  *open = lanes_set(entry <= leave);
  return entry;
}

/// Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection": the ray is sheared onto its
/// longest axis.
typedef struct {
  long x, y, z;  ///< axes; z is the direction's longest
  float shear_x, shear_y, shear_z;
} ShearRay;

DS_FN ShearRay shear_ray(const Ray* ray, const float* inverse) {
  const float* d = ray->direction;
  ShearRay s;
  s.z = fabs(d[0]) > fabs(d[1]) ? (fabs(d[0]) > fabs(d[2]) ? 0 : 2)
                                : (fabs(d[1]) > fabs(d[2]) ? 1 : 2);
  s.x = s.z == 2 ? 0 : s.z + 1;
  s.y = s.x == 2 ? 0 : s.x + 1;
  s.shear_z = inverse[s.z];
  s.shear_x = d[s.x] * s.shear_z;
  s.shear_y = d[s.y] * s.shear_z;
  return s;
}

/// The distances to the triangles' planes, for rays that start so near one that test_leaf's mean of
/// corner depths cannot tell on which side: beside a wall of 10 m that is 2 micrometres. Of a plane
/// across an axis this is exact, and no ground is met from behind by a ray that leaves a thing
/// standing in it, nor missed by one that comes down beside it. Rarely asked, and of the ray and
/// the triangle alone. Infinite or NaN for a ray in the plane.
DS_FN float8 plane_distance(const __global float8* xs, const __global float8* ys,
                            const __global float8* zs, float8 ox, float8 oy, float8 oz,
                            float8 minus_shear_x, float8 minus_shear_y, float shear_z) {
  const float8 e1x = xs[3] - xs[0];
  const float8 e1y = ys[3] - ys[0];
  const float8 e1z = zs[3] - zs[0];
  const float8 e2x = xs[6] - xs[0];
  const float8 e2y = ys[6] - ys[0];
  const float8 e2z = zs[6] - zs[0];
  const float8 nx = e1y * e2z - e1z * e2y;
  const float8 ny = e1z * e2x - e1x * e2z;
  const float8 nz = e1x * e2y - e1y * e2x;
  const float8 height = nx * (xs[0] - ox) + ny * (ys[0] - oy) + nz * (zs[0] - oz);
  return height / (nz - nx * minus_shear_x - ny * minus_shear_y) * shear_z;
}

/// What a leaf's eight triangles answer. An edge's function is a difference of two products, each
/// rounded: swapping its ends negates it exactly, so two triangles never both miss a ray through
/// their common edge. No fma there for that reason. `t` is a mean of corner depths with weights of
/// one sign, so it is right to a few ulps even for slivers.
typedef struct {
  float8 t, weight1, weight2, inverse_sum;
  int8 met;  ///< in (0, t_max]
} LeafTest;

DS_FN LeafTest test_leaf(const __global float8* leaf, ulong x, ulong y, ulong z, float8 ox,
                         float8 oy, float8 oz, float8 minus_shear_x, float8 minus_shear_y,
                         float shear_z, float t_max) {
  const __global float8* xs = leaf + x;
  const __global float8* ys = leaf + y;
  const __global float8* zs = leaf + z;
  const float8 az = zs[0] - oz;
  const float8 bz = zs[3] - oz;
  const float8 cz = zs[6] - oz;
  const float8 ax = fma(minus_shear_x, az, xs[0] - ox);
  const float8 ay = fma(minus_shear_y, az, ys[0] - oy);
  const float8 bx = fma(minus_shear_x, bz, xs[3] - ox);
  const float8 by = fma(minus_shear_y, bz, ys[3] - oy);
  const float8 cx = fma(minus_shear_x, cz, xs[6] - ox);
  const float8 cy = fma(minus_shear_y, cz, ys[6] - oy);
  const float8 u = cx * by - cy * bx;
  const float8 v = ax * cy - ay * cx;
  const float8 w = bx * ay - by * ax;
  const float8 sum = u + v + w;
  LeafTest test;
  test.inverse_sum = 1.0f / sum;
  test.t = fma(u, az, fma(v, bz, w * cz)) * shear_z * test.inverse_sum;
  test.weight1 = v;
  test.weight2 = w;
  const int8 inside =
      ((u >= 0.0f) & (v >= 0.0f) & (w >= 0.0f)) | ((u <= 0.0f) & (v <= 0.0f) & (w <= 0.0f));
  const float8 farthest = greater8(fabs(az), greater8(fabs(bz), fabs(cz)));
  const int8 crossed = inside & (sum != 0.0f);
  const int8 doubtful = crossed & (fabs(test.t) <= farthest * (k_doubtful_t * fabs(shear_z)));
  if (lanes_set(doubtful)) {
    test.t = doubtful
                 ? plane_distance(xs, ys, zs, ox, oy, oz, minus_shear_x, minus_shear_y, shear_z)
                 : test.t;
  }
  test.met = crossed & (test.t > 0.0f) & (test.t <= t_max);
  return test;
}

DS_FN LeafTest test_leaf(const __global float8* leaf, const Ray* ray, const ShearRay* s,
                         float t_max) {
  return test_leaf(leaf, (ulong)s->x, (ulong)s->y, (ulong)s->z, (float8)(ray->origin[s->x]),
                   (float8)(ray->origin[s->y]), (float8)(ray->origin[s->z]), (float8)(-s->shear_x),
                   (float8)(-s->shear_y), s->shear_z, t_max);
}

/// Takes the leaf's nearest triangle where it is nearer than `hit`, or as near and of a lesser id.
DS_FN void nearest_in_leaf(const __global float8* leaf, const Ray* ray, const ShearRay* s,
                           Hit* hit) {
  const LeafTest found = test_leaf(leaf, ray, s, hit->t);
  LaneSet left = lanes_set(found.met);
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

/// Numbers that are none, or beyond what a scene may hold, make NaN of box tests, and NaN would
/// meet the boxes of absent children for ever. Such a ray hits nothing.
DS_FN bool is_traceable(const Ray* ray) {
  bool sound = true;
  for (int axis = 0; axis < 3; ++axis)
    sound = sound && fabs(ray->origin[axis]) <= 1e18f && fabs(ray->direction[axis]) <= 1e18f;
  return sound;
}

/// The nearest hit in (0, t_max].
static Hit nearest_hit(const __global float8* nodes, const __global float8* leaves, Ray ray) {
  const SlabRay slab = slab_ray(nodes, &ray);
  const ShearRay shear = shear_ray(&ray, slab.inverse);
  Hit hit;
  hit.t = ray.t_max;
  hit.b1 = hit.b2 = 0.0f;
  hit.id = k_none;
  if (!is_traceable(&ray)) return hit;
  Stack stack;
  int size = 0;
  uint current = 0;
  for (;;) {
    while (!(current & k_leaf_bit)) {
      const __global float8* node = nodes + current * k_node_vectors;
      LaneSet open;
      const float8 entries = test_boxes(node, &slab, 0.0f, hit.t, &open);
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
    } while (stack.entry[size] > hit.t);
    current = stack.node[size];
  }
}

/// True where anything is hit in (0, t_max].
static bool any_hit(const __global float8* nodes, const __global float8* leaves, Ray ray) {
  if (!is_traceable(&ray)) return false;
  const SlabRay slab = slab_ray(nodes, &ray);
  const ShearRay shear = shear_ray(&ray, slab.inverse);
  uint stack[k_bvh_stack];
  int size = 0;
  uint current = 0;
  for (;;) {
    while (!(current & k_leaf_bit)) {
      const __global float8* node = nodes + current * k_node_vectors;
      LaneSet open;
      test_boxes(node, &slab, 0.0f, ray.t_max, &open);
      if (!open) goto next;
      const __global uint* child = (const __global uint*)(node + k_node_children);
      current = child[first_lane(open)];
      for (open = without_first(open); open; open = without_first(open)) {
        stack[size++] = child[first_lane(open)];
      }
    }
    if (lanes_set(
            test_leaf(leaves + (current & ~k_leaf_bit) * k_leaf_vectors, &ray, &shear, ray.t_max)
                .met))
      return true;
  next:
    if (size == 0) return false;
    current = stack[--size];
  }
}
