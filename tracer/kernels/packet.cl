// SPDX-License-Identifier: Apache-2.0
// Nearest hits of rays that keep together, as those through neighbouring pixels do: all lanes' rays
// walk the tree as one packet, and each box and each triangle is tested against all of them at once
// (Wald and others 2001, "Interactive Rendering with Coherent Ray Tracing"). A node is visited where any ray's
// box test says so, with the arithmetic of bvh.cl, so hits are those of bvh.cl's single rays, bit for
// bit; a packet whose rays part is as slow as all of their ways together.
#pragma once

#include "tracer/kernels/batch.cl"

#if DS_LANES > 1

DS_FN float4 lesser4(float4 a, float4 b) {
  return a < b ? a : b;
}

DS_FN float least_lane(real v) {
#  if DS_LANES == 16
  const float8 eight = lesser8(v.lo, v.hi);
  const float4 four = lesser4(eight.lo, eight.hi);
#  elif DS_LANES == 8
  const float4 four = lesser4(v.lo, v.hi);
#  else
  const float4 four = v;
#  endif
  const float4 two = lesser4(four, four.zwxy);
  const float4 one = lesser4(two, two.yxwz);
  return one.x;
}

DS_FN float greatest_lane(real v) {
  return -least_lane(-v);
}

/// Whether the wanted rays, one at least, meet the planes of each axis in one order and have one
/// longest axis.
DS_FN bool keep_together(const Batch* b, mask wanted) {
  const natural way =
      *(const natural*)&b->near_plane[0][0] | (*(const natural*)&b->near_plane[1][0] << 8u) |
      (*(const natural*)&b->near_plane[2][0] << 16u) | (*(const natural*)&b->axis_z[0] << 24u);
  return !any_lane(wanted & (way != first_of(wanted, way)));
}

/// What box and triangle tests need of the rays of a packet.
typedef struct {
  real inverse[3], near_offset[3], far_offset[3];
  ulong near_plane[3];  ///< of all rays, as in SlabRay
  real x, y, z;         ///< the origin, by the axes of the shear
  real minus_shear_x, minus_shear_y, shear_z;
  ulong axis_x, axis_y, axis_z;
} Packet;

DS_FN Packet packet_of(const Batch* b, uint lane) {
  Packet p;
  for (int axis = 0; axis < 3; ++axis) {
    p.inverse[axis] = *(const real*)&b->inverse[axis][0];
    p.near_offset[axis] = *(const real*)&b->near_offset[axis][0];
    p.far_offset[axis] = *(const real*)&b->far_offset[axis][0];
    p.near_plane[axis] = b->near_plane[axis][lane];
  }
  p.axis_x = b->axis_x[lane];
  p.axis_y = b->axis_y[lane];
  p.axis_z = b->axis_z[lane];
  p.x = *(const real*)&b->origin[p.axis_x][0];
  p.y = *(const real*)&b->origin[p.axis_y][0];
  p.z = *(const real*)&b->origin[p.axis_z][0];
  p.minus_shear_x = *(const real*)&b->minus_shear_x[0];
  p.minus_shear_y = *(const real*)&b->minus_shear_y[0];
  p.shear_z = *(const real*)&b->shear_z[0];
  return p;
}

/// Puts the children that a ray meets before its `t` on the stack, the nearest on top; returns its
/// new height.
DS_FN int push_met(const Packet* p, const __global float* node, real t, Stack* stack, int size) {
  const __global uint* child = (const __global uint*)(node + k_node_children * k_bvh_width);
  const int base = size;
  for (uint i = 0; i < k_bvh_width; ++i) {
    real entry = (real)(0.0f), leave = t;
    for (int axis = 0; axis < 3; ++axis) {
      const float first = node[p->near_plane[axis] + i];
      const float last = node[(p->near_plane[axis] ^ k_bvh_width) + i];
      entry = greater(fma((real)(first), p->inverse[axis], p->near_offset[axis]), entry);
      leave = lesser(fma((real)(last), p->inverse[axis], p->far_offset[axis]), leave);
    }
    const mask open = entry <= leave;
    if (!any_lane(open)) continue;
    const float nearest = least_lane(choose(open, entry, (real)(INFINITY)));
    int at = size++;
    for (; at > base && stack->entry[at - 1] < nearest; --at) {
      stack->entry[at] = stack->entry[at - 1];
      stack->node[at] = stack->node[at - 1];
    }
    stack->entry[at] = nearest;
    stack->node[at] = child[i];
  }
  return size;
}

/// Takes each ray's nearest triangle of a leaf, as nearest_in_leaf does. False where a distance is in
/// doubt (LeafTest): then nothing it has put into t and id counts.
DS_FN bool nearest_of_leaf(const Packet* p, const __global float8* leaf, mask wanted, real* t,
                           natural* id) {
  const __global uint* ids = (const __global uint*)(leaf + k_leaf_ids);
  const __global float* xs = (const __global float*)(leaf + p->axis_x);
  const __global float* ys = (const __global float*)(leaf + p->axis_y);
  const __global float* zs = (const __global float*)(leaf + p->axis_z);
  const uint b = 3 * k_bvh_width, c = 6 * k_bvh_width;
  // They ascend; absent ones behind them are 0.
  for (uint i = 0; i < k_bvh_width && (i == 0 || ids[i] > ids[i - 1]); ++i) {
    const real az = zs[i] - p->z;
    const real bz = zs[b + i] - p->z;
    const real cz = zs[c + i] - p->z;
    const real ax = fma(p->minus_shear_x, az, xs[i] - p->x);
    const real ay = fma(p->minus_shear_y, az, ys[i] - p->y);
    const real bx = fma(p->minus_shear_x, bz, xs[b + i] - p->x);
    const real by = fma(p->minus_shear_y, bz, ys[b + i] - p->y);
    const real cx = fma(p->minus_shear_x, cz, xs[c + i] - p->x);
    const real cy = fma(p->minus_shear_y, cz, ys[c + i] - p->y);
    const real u = cx * by - cy * bx;
    const real v = ax * cy - ay * cx;
    const real w = bx * ay - by * ax;
    const real sum = u + v + w;
    const mask inside =
        ((u >= 0.0f) & (v >= 0.0f) & (w >= 0.0f)) | ((u <= 0.0f) & (v <= 0.0f) & (w <= 0.0f));
    const mask crossed = wanted & inside & (sum != 0.0f);
    if (!any_lane(crossed)) continue;
    const real inverse_sum = 1.0f / sum;
    const real at = fma(u, az, fma(v, bz, w * cz)) * p->shear_z * inverse_sum;
    const real farthest = greater(absolute(az), greater(absolute(bz), absolute(cz)));
    if (any_lane(crossed & (absolute(at) <= farthest * (k_doubtful_t * absolute(p->shear_z)))))
      return false;
    const mask nearer = crossed & (at > 0.0f) & ((at < *t) | ((at == *t) & (ids[i] < *id)));
    *t = choose(nearer, at, *t);
    *id = choose_natural(nearer, (natural)(ids[i]), *id);
  }
  return true;
}

/// The nearest hits of the wanted rays (one at least) of a batch, of those that keep_together. False
/// where they must be traced singly; the batch is then as it was.
DS_OUT_OF_LINE bool trace_packet(Batch* b, mask wanted, const __global float8* nodes,
                                 const __global float8* leaves) {
  const Packet p = packet_of(b, first_of(wanted, DS_LANE_NUMBERS));
  real t = choose(wanted, *(const real*)&b->t[0], (real)(-1.0f));
  natural id = (natural)(k_none);
  Stack stack;
  stack.node[0] = 0;
  stack.entry[0] = 0.0f;
  int size = 1;
  float farthest = greatest_lane(t);
  while (size > 0) {
    --size;
    if (stack.entry[size] > farthest) continue;
    const uint at = stack.node[size];
    if (!(at & k_leaf_bit)) {
      size = push_met(&p, (const __global float*)(nodes + (ulong)at * k_node_vectors), t, &stack,
                      size);
      continue;
    }
    if (!nearest_of_leaf(&p, leaves + (ulong)(at & ~k_leaf_bit) * k_leaf_vectors, wanted, &t, &id))
      return false;
    farthest = greatest_lane(t);
  }
  *(real*)&b->t[0] = choose(wanted, t, *(const real*)&b->t[0]);
  *(natural*)&b->id[0] = id;
  return true;
}

#endif
