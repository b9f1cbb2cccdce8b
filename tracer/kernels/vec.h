// SPDX-License-Identifier: Apache-2.0
// Three-vectors of lanes: directions, points, colours.
#pragma once

#include "tracer/kernels/lanes.h"

typedef struct {
  real x, y, z;
} real3;

DS_FN real3 vec(real x, real y, real z) {
  real3 r;
  r.x = x;
  r.y = y;
  r.z = z;
  return r;
}
DS_FN real3 splat(real a) {
  return vec(a, a, a);
}
DS_FN real3 add(real3 a, real3 b) {
  return vec(a.x + b.x, a.y + b.y, a.z + b.z);
}
DS_FN real3 sub(real3 a, real3 b) {
  return vec(a.x - b.x, a.y - b.y, a.z - b.z);
}
DS_FN real3 mul(real3 a, real3 b) {
  return vec(a.x * b.x, a.y * b.y, a.z * b.z);
}
DS_FN real3 scale(real3 a, real s) {
  return vec(a.x * s, a.y * s, a.z * s);
}
DS_FN real3 negate(real3 a) {
  return vec(-a.x, -a.y, -a.z);
}
/// a + b s
DS_FN real3 add_scaled(real3 a, real3 b, real s) {
  return vec(fma(b.x, s, a.x), fma(b.y, s, a.y), fma(b.z, s, a.z));
}
DS_FN real dot(real3 a, real3 b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
/// `v` mirrored on the plane of `normal` (unit).
DS_FN real3 mirror_image(real3 v, real3 normal) {
  return add_scaled(v, normal, -2.0f * dot(v, normal));
}
DS_FN real3 cross(real3 a, real3 b) {
  return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
DS_FN real3 choose(mask m, real3 a, real3 b) {
  return vec(choose(m, a.x, b.x), choose(m, a.y, b.y), choose(m, a.z, b.z));
}
DS_FN real max_component(real3 a) {
  return greater(a.x, greater(a.y, a.z));
}
/// Rec.709 luminance.
DS_FN real luminance(real3 a) {
  return 0.2126f * a.x + 0.7152f * a.y + 0.0722f * a.z;
}
/// Unit vector. Domain: squared length in [1e-30, 1e30]; below that the result is shorter than 1,
/// never NaN.
DS_FN real3 unit(real3 a) {
  const real squared = greater(dot(a, a), (real)(1e-30f));
  return scale(a, 1.0f / sqrt(squared));
}
/// Unit normal of a triangle whose edges from its first corner these are; zero where it has no
/// area. Edges are scaled by their greatest component, 1e-37 to 1e37: no triangle is so small or so
/// large that its normal is lost.
DS_FN real3 triangle_normal(real3 e1, real3 e2) {
  const real3 size =
      vec(greater(absolute(e1.x), absolute(e2.x)), greater(absolute(e1.y), absolute(e2.y)),
          greater(absolute(e1.z), absolute(e2.z)));
  const real s = 1.0f / greater(max_component(size), (real)(1e-37f));
  return unit(cross(scale(e1, s), scale(e2, s)));
}
DS_FN real3 load3(DS_GLOBAL float* p, natural i) {
  return vec(load(p, i), load(p, i + 1u), load(p, i + 2u));
}
DS_FN real3 lerp3(real3 a, real3 b, real t) {
  return vec(fma(b.x - a.x, t, a.x), fma(b.y - a.y, t, a.y), fma(b.z - a.z, t, a.z));
}

/// An orthonormal frame whose z axis is `n`.
typedef struct {
  real3 t, b, n;
} Frame;

/// Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3; continuous but at n.z =
/// 0 crossing signs.
DS_FN Frame frame_around(real3 n) {
  const real s = with_sign_of((real)(1.0f), n.z);
  const real a = -1.0f / (s + n.z);
  const real c = n.x * n.y * a;
  Frame f;
  f.t = vec(1.0f + s * n.x * n.x * a, s * c, -s * n.x);
  f.b = vec(c, s + n.y * n.y * a, -n.y);
  f.n = n;
  return f;
}
DS_FN real3 to_local(Frame f, real3 v) {
  return vec(dot(v, f.t), dot(v, f.b), dot(v, f.n));
}
DS_FN real3 to_world(Frame f, real3 v) {
  return add_scaled(add_scaled(scale(f.n, v.z), f.b, v.y), f.t, v.x);
}
