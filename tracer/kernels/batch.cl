// SPDX-License-Identifier: Apache-2.0
// Rays of all lanes at once: nearest hits for the paths' next surfaces, any hits for the shadow
// rays of their last. The answers are those of bvh.cl's single rays, bit for bit.
//
// A ray's next step waits for its last one (some 50 cycles a node), and what it finds mispredicts
// branches. So each lane's rays take one step in turn: steps of different rays do not wait for each
// other. A list says which rays test a node's boxes next, which a leaf's triangles, which climb
// back to what is left; a pass over a list moves each ray to its next list without a branch.
//
// A ray's way back is a stack of levels, one a node with open children left: the children's entry
// distances with the child's number in the three lowest bits (so compared a little too near, which
// is safe), all ones where there is nothing to do. A child is visited once it is the least.
#pragma once

#include "tracer/kernels/bvh.cl"
#include "tracer/kernels/sampler.h"
#include "tracer/kernels/shear.h"

/// Places of a batch: nearest-hit rays first, then any-hit rays, one a lane.
enum { k_batch_any = DS_LANES, k_batch_rays = 2 * DS_LANES };

/// What a batch's nearest-hit rays met; `id` is k_none where nothing was.
typedef struct {
  float t[DS_LANES] __attribute__((aligned(64)));
  uint id[DS_LANES] __attribute__((aligned(64)));
  int any[DS_LANES] __attribute__((aligned(64)));  ///< -1 where an any-hit ray met something
} BatchHits;

/// A ray a lane, as asked for. Directions are unit.
typedef struct {
  real3 origin, direction;
  real t_max;
  mask wanted;
} LaneRays;

/// Rays that bvh.cl's is_traceable takes.
DS_FN mask traceable_lanes(const LaneRays* rays) {
  const real limit = (real)(1e18f);
  return (absolute(rays->origin.x) <= limit) & (absolute(rays->origin.y) <= limit) &
         (absolute(rays->origin.z) <= limit) & (absolute(rays->direction.x) <= limit) &
         (absolute(rays->direction.y) <= limit) & (absolute(rays->direction.z) <= limit) &
         (rays->t_max > 0.0f);
}

DS_FN real component(real3 v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

#if DS_LANES == 1

DS_FN void trace_lanes(const __global float8* nodes, const __global float8* leaves,
                       const LaneRays* nearest, const LaneRays* any, BatchHits* hits) {
  const Hit none = {0.0f, 0.0f, 0.0f, k_none};
  const Ray first = {{nearest->origin.x, nearest->origin.y, nearest->origin.z},
                     {nearest->direction.x, nearest->direction.y, nearest->direction.z},
                     nearest->t_max};
  const Hit hit = nearest->wanted ? nearest_hit(nodes, leaves, first) : none;
  hits->t[0] = hit.t;
  hits->id[0] = hit.id;
  const Ray second = {{any->origin.x, any->origin.y, any->origin.z},
                      {any->direction.x, any->direction.y, any->direction.z},
                      any->t_max};
  hits->any[0] = any->wanted && any_hit(nodes, leaves, second) ? -1 : 0;
}

#else

typedef struct {
  // What box and triangle tests need of a ray (SlabRay, ShearRay), a ray an element.
  float inverse[3][k_batch_rays] __attribute__((aligned(64)));
  float near_offset[3][k_batch_rays] __attribute__((aligned(64)));
  float far_offset[3][k_batch_rays] __attribute__((aligned(64)));
  uint near_plane[3][k_batch_rays] __attribute__((aligned(64)));
  float origin[3][k_batch_rays] __attribute__((aligned(64)));
  float minus_shear_x[k_batch_rays] __attribute__((aligned(64)));
  float minus_shear_y[k_batch_rays] __attribute__((aligned(64)));
  float shear_z[k_batch_rays] __attribute__((aligned(64)));
  uint axis_x[k_batch_rays] __attribute__((aligned(64)));
  uint axis_y[k_batch_rays] __attribute__((aligned(64)));
  uint axis_z[k_batch_rays] __attribute__((aligned(64)));
  float t[k_batch_rays] __attribute__((aligned(64)));  ///< nearest hit so far, else the ray's t_max
  uint id[k_batch_rays] __attribute__((aligned(64)));
  uint reference[k_batch_rays];  ///< node or leaf to test next
  uint top[k_batch_rays];        ///< place of the uppermost level in `entries` and `parent`
  // The lists, each with room for the element that a step writes but does not count.
  uint at_node[k_batch_rays + 1], at_leaf[k_batch_rays + 1], climbing[k_batch_rays + 1];
  // Level `l` of ray `r` stands at l * k_batch_rays + r. Level 0 is a guard with nothing left.
  uint parent[(k_bvh_depth + 1) * k_batch_rays];
  uint8 entries[(k_bvh_depth + 1) * k_batch_rays];
} Batch;

/// The least element, in every element.
DS_FN uint8 least_of(uint8 v) {
  const uint4 four = min(v.lo, v.hi);
  const uint4 two = min(four, four.zwxy);
  const uint4 one = min(two, two.yxwz);
  return (uint8)(one, one);
}

/// slab_ray and shear_ray for all lanes.
DS_FN void prepare_rays(Batch* b, int place, const __global float8* nodes, const LaneRays* rays) {
  const __global float* bounds = (const __global float*)(nodes + k_root_bounds);
  real3 inverse;
  real distance = rays->t_max;
  real* inverses[3] = {&inverse.x, &inverse.y, &inverse.z};
  for (int axis = 0; axis < 3; ++axis) {
    const real i = inverse_of(component(rays->direction, axis));
    const real plane = choose(i < 0.0f, (real)(bounds[axis]), (real)(bounds[3 + axis]));
    distance = lesser(distance, (plane - component(rays->origin, axis)) * i);
    *inverses[axis] = i;
  }
  distance = greater(distance, (real)(0.0f));
  for (int axis = 0; axis < 3; ++axis) {
    const real o = component(rays->origin, axis);
    const real i = component(inverse, axis);
    const real offset = -o * i;
    const real margin = k_slab_error * (absolute(o) + distance);
    const real widen = fma(margin, absolute(i), k_slab_error * distance);
    const uint first = 2 * axis * k_bvh_width;
    *(real*)&b->inverse[axis][place] = i;
    *(real*)&b->near_offset[axis][place] = offset - widen;
    *(real*)&b->far_offset[axis][place] = offset + widen;
    *(natural*)&b->near_plane[axis][place] =
        choose_natural(i < 0.0f, (natural)(first + k_bvh_width), (natural)(first));
    *(real*)&b->origin[axis][place] = o;
  }
  const LaneShear shear = lane_shear(rays->direction);
  *(natural*)&b->axis_x[place] = shear.x;
  *(natural*)&b->axis_y[place] = shear.y;
  *(natural*)&b->axis_z[place] = shear.z;
  *(real*)&b->minus_shear_x[place] = shear.minus_shear_x;
  *(real*)&b->minus_shear_y[place] = shear.minus_shear_y;
  *(real*)&b->shear_z[place] = shear.shear_z;
  *(real*)&b->t[place] = rays->t_max;
}

/// Prepares the rays and puts the wanted ones on the list of those that test a node (the root).
DS_OUT_OF_LINE uint add_rays(Batch* b, int place, uint count, const __global float8* nodes,
                             const LaneRays* rays) {
  int wanted[DS_LANES] __attribute__((aligned(64)));
  *(mask*)wanted = rays->wanted & traceable_lanes(rays);
  prepare_rays(b, place, nodes, rays);
  for (int lane = 0; lane < DS_LANES; ++lane) {
    const uint ray = (uint)(place + lane);
    b->id[ray] = k_none;
    b->reference[ray] = 0;
    b->top[ray] = ray;
    b->parent[ray] = 0;
    b->entries[ray] = (uint8)(0xffffffffu);
    b->at_node[count] = ray;
    count += wanted[lane] != 0 ? 1u : 0u;
  }
  return count;
}

/// How many rays each list holds.
typedef struct {
  uint at_node, at_leaf, climbing;
} Counts;

/// Tests the boxes of each ray's node; its nearest open child is next, the others make a level.
DS_FN Counts step_nodes(Batch* b, Counts n, const __global float8* nodes) {
  const uint8 numbers = (uint8)(0, 1, 2, 3, 4, 5, 6, 7);
  Counts after = n;
  after.at_node = 0;
  for (uint i = 0; i < n.at_node; ++i) {
    const ulong ray = b->at_node[i];
    const uint reference = b->reference[ray];
    const __global float* node = (const __global float*)(nodes + (ulong)reference * k_node_vectors);
    const ulong plane_x = b->near_plane[0][ray];
    const ulong plane_y = b->near_plane[1][ray];
    const ulong plane_z = b->near_plane[2][ray];
    const float8 inverse_x = (float8)(b->inverse[0][ray]);
    const float8 inverse_y = (float8)(b->inverse[1][ray]);
    const float8 inverse_z = (float8)(b->inverse[2][ray]);
    // Planes of one axis are neighbours: low, then high.
#  define DS_PLANE(place) (*(const __global float8*)(node + (place)))
    const float8 near_x = fma(DS_PLANE(plane_x), inverse_x, (float8)(b->near_offset[0][ray]));
    const float8 near_y = fma(DS_PLANE(plane_y), inverse_y, (float8)(b->near_offset[1][ray]));
    const float8 near_z = fma(DS_PLANE(plane_z), inverse_z, (float8)(b->near_offset[2][ray]));
    const float8 far_x =
        fma(DS_PLANE(plane_x ^ k_bvh_width), inverse_x, (float8)(b->far_offset[0][ray]));
    const float8 far_y =
        fma(DS_PLANE(plane_y ^ k_bvh_width), inverse_y, (float8)(b->far_offset[1][ray]));
    const float8 far_z =
        fma(DS_PLANE(plane_z ^ k_bvh_width), inverse_z, (float8)(b->far_offset[2][ray]));
#  undef DS_PLANE
    const float8 entry = greater8(greater8(near_x, near_y), greater8(near_z, (float8)(0.0f)));
    const float8 leave = lesser8(lesser8(far_x, far_y), lesser8(far_z, (float8)(b->t[ray])));
    const int8 open = entry <= leave;
    const uint8 entries = ((as_uint8(entry) & ~7u) | numbers) | ~as_uint8(open);
    const uint8 least = least_of(entries);
    const LaneSet set = lanes_set(open);
    const uint child =
        ((const __global uint*)(node + k_node_children * k_bvh_width))[least.s0 & 7u];
    const uint top = b->top[ray];
    b->entries[top + k_batch_rays] = entries | as_uint8(entries == least);
    b->parent[top + k_batch_rays] = reference;
    b->top[ray] = top + (without_first(set) != 0 ? (uint)k_batch_rays : 0u);
    b->reference[ray] = child;
    const uint some = set != 0 ? 1u : 0u;
    const uint leaf = child >> 31;
    b->at_node[after.at_node] = (uint)ray;
    after.at_node += some & ~leaf;
    b->at_leaf[after.at_leaf] = (uint)ray;
    after.at_leaf += some & leaf;
    b->climbing[after.climbing] = (uint)ray;
    after.climbing += 1u - some;
  }
  return after;
}

/// Tests the triangles of each ray's leaf. An any-hit ray that meets one is done.
DS_FN Counts step_leaves(Batch* b, Counts n, const __global float8* leaves) {
  Counts after = n;
  after.at_leaf = 0;
  for (uint i = 0; i < n.at_leaf; ++i) {
    const ulong ray = b->at_leaf[i];
    const __global float8* leaf =
        leaves + (ulong)(b->reference[ray] & ~k_leaf_bit) * k_leaf_vectors;
    const ulong x = b->axis_x[ray];
    const ulong y = b->axis_y[ray];
    const ulong z = b->axis_z[ray];
    const float t_max = b->t[ray];
    const LeafTest test =
        test_leaf(leaf, x, y, z, (float8)(b->origin[x][ray]), (float8)(b->origin[y][ray]),
                  (float8)(b->origin[z][ray]), (float8)(b->minus_shear_x[ray]),
                  (float8)(b->minus_shear_y[ray]), b->shear_z[ray], t_max);
    // Distances are positive, so their bits compare as they do.
    const uint8 distances = as_uint8(test.t) | ~as_uint8(test.met);
    const uint8 least = least_of(distances);
    const uint first = (uint)first_lane(lanes_set(as_int8(distances == least)));
    const uint id = ((const __global uint*)(leaf + k_leaf_ids))[first];
    const float t = as_float(least.s0);
    const uint met = least.s0 != 0xffffffffu ? 1u : 0u;
    const bool nearer = met && (t < t_max || (t == t_max && id < b->id[ray]));
    b->t[ray] = nearer ? t : t_max;
    b->id[ray] = nearer ? id : b->id[ray];
    b->climbing[after.climbing] = (uint)ray;
    after.climbing += 1u - (met & (ray >= k_batch_any ? 1u : 0u));
  }
  return after;
}

/// Takes each ray to the nearest child left on its uppermost level, or, where that lies behind its
/// hit, one level down. A ray that has no level left is done.
DS_FN Counts step_climbing(Batch* b, Counts n, const __global float8* nodes) {
  Counts after = n;
  after.climbing = 0;
  for (uint i = 0; i < n.climbing; ++i) {
    const ulong ray = b->climbing[i];
    const ulong top = b->top[ray];
    const uint8 entries = b->entries[top];
    const uint8 least = least_of(entries);
    const uint8 left = entries | as_uint8(entries == least);
    const uint culled = (least.s0 & ~7u) > as_uint(b->t[ray]) ? 1u : 0u;
    const uint emptied = lanes_set(as_int8(left != 0xffffffffu)) == 0 ? 1u : 0u;
    b->entries[top] = left;
    b->top[ray] = (uint)top - ((culled | emptied) != 0 ? (uint)k_batch_rays : 0u);
    const __global uint* children =
        (const __global uint*)(nodes + (ulong)b->parent[top] * k_node_vectors + k_node_children);
    const uint child = children[least.s0 & 7u];
    b->reference[ray] = child;
    const uint leaf = child >> 31;
    b->at_node[after.at_node] = (uint)ray;
    after.at_node += ~culled & ~leaf & 1u;
    b->at_leaf[after.at_leaf] = (uint)ray;
    after.at_leaf += ~culled & leaf;
    b->climbing[after.climbing] = (uint)ray;
    after.climbing += culled & (top >= k_batch_rays ? 1u : 0u);
  }
  return after;
}

/// Traces the lanes' wanted rays.
DS_OUT_OF_LINE void trace_lanes(const __global float8* nodes, const __global float8* leaves,
                                const LaneRays* nearest, const LaneRays* any, BatchHits* hits) {
  Batch b;
  Counts n = {0, 0, 0};
  n.at_node = add_rays(&b, 0, 0, nodes, nearest);
  n.at_node = add_rays(&b, k_batch_any, n.at_node, nodes, any);
  while ((n.at_node | n.at_leaf | n.climbing) != 0) {
    n = step_nodes(&b, n, nodes);
    n = step_leaves(&b, n, leaves);
    n = step_climbing(&b, n, nodes);
  }
  *(real*)hits->t = *(const real*)&b.t[0];
  *(natural*)hits->id = *(const natural*)&b.id[0];
  *(mask*)hits->any = *(const natural*)&b.id[k_batch_any] != k_none;
}

#endif
