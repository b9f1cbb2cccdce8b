// SPDX-License-Identifier: Apache-2.0
// Rays sheared onto their greatest axis (Woop, Benthin, Wald 2013, as bvh.cl), of all lanes, and
// where on its triangle a ray's hit is. Compiles for the host too: tests/precision audits it.
#pragma once

#include "tracer/kernels/vec.h"

DS_FN real chosen_component(natural axis, real3 v) {
  return choose(axis == 0u, v.x, choose(axis == 1u, v.y, v.z));
}

/// 1 / d, held finite as slab_ray does.
DS_FN real inverse_of(real d) {
  return 1.0f / choose(absolute(d) < 1e-18f, with_sign_of((real)(1e-18f), d), d);
}

/// ShearRay of all lanes.
typedef struct {
  natural x, y, z;
  real minus_shear_x, minus_shear_y, shear_z;
} LaneShear;

DS_FN LaneShear lane_shear(real3 direction) {
  const real x = absolute(direction.x);
  const real y = absolute(direction.y);
  const real z = absolute(direction.z);
  const natural zero = (natural)(0u), two = (natural)(2u);
  LaneShear s;
  s.z = choose_natural(x > y, choose_natural(x > z, zero, two),
                       choose_natural(y > z, (natural)(1u), two));
  s.x = choose_natural(s.z == 2u, zero, s.z + 1u);
  s.y = choose_natural(s.x == 2u, zero, s.x + 1u);
  s.shear_z = inverse_of(chosen_component(s.z, direction));
  s.minus_shear_x = -(chosen_component(s.x, direction) * s.shear_z);
  s.minus_shear_y = -(chosen_component(s.y, direction) * s.shear_z);
  return s;
}

/// Barycentric weights of corners 1 (x) and 2 (y) where a ray meets a triangle that it is known to
/// hit: the arithmetic of bvh.cl's test_leaf.
DS_FN real2 hit_weights(real3 origin, real3 direction, real3 p0, real3 p1, real3 p2) {
  const LaneShear s = lane_shear(direction);
  const real3 a = sub(p0, origin), b = sub(p1, origin), c = sub(p2, origin);
  const real az = chosen_component(s.z, a);
  const real bz = chosen_component(s.z, b);
  const real cz = chosen_component(s.z, c);
  const real ax = fma(s.minus_shear_x, az, chosen_component(s.x, a));
  const real ay = fma(s.minus_shear_y, az, chosen_component(s.y, a));
  const real bx = fma(s.minus_shear_x, bz, chosen_component(s.x, b));
  const real by = fma(s.minus_shear_y, bz, chosen_component(s.y, b));
  const real cx = fma(s.minus_shear_x, cz, chosen_component(s.x, c));
  const real cy = fma(s.minus_shear_y, cz, chosen_component(s.y, c));
  const real u = cx * by - cy * bx;
  const real v = ax * cy - ay * cx;
  const real w = bx * ay - by * ax;
  const real inverse_sum = 1.0f / (u + v + w);
  real2 weights;
  weights.x = v * inverse_sum;
  weights.y = w * inverse_sum;
  return weights;
}
