// SPDX-License-Identifier: Apache-2.0
// What is known of a surface point before its material is asked.
#pragma once

#include "tracer/kernels/vec.h"

typedef struct {
  real3 position;  ///< world, metres
  real3 normal;    ///< geometric, unit, on the viewer's side
  real3 shading;   ///< interpolated, unit, on the viewer's side, never more than 89.4 degrees from
                   ///< the viewer
  real3 error;     ///< bound of the position's rounding error, by component
  real u, v;
  real b1, b2;     ///< weights of the triangle's second and third corner
  natural colors;  ///< its row of colours (hit_colors.h)
  mask outside;  ///< the triangle's own normal (counter-clockwise corners) is on the viewer's side
} Surface;

/// A ray's origin off the surface, on the side that `direction` leaves to: far enough that no
/// rounding puts it on the other side, near enough that nothing is seen through (Pharr, Jakob and
/// Humphreys 2016, 3.9.5). The bound is doubled because the triangle test has its own few ulps.
DS_FN real3 offset_origin(real3 position, real3 error, real3 normal, real3 direction) {
  const real distance = 2.0f * (absolute(normal.x) * error.x + absolute(normal.y) * error.y +
                                absolute(normal.z) * error.z);
  return add_scaled(position, normal, with_sign_of(distance, dot(direction, normal)));
}

/// Rounding of a point p0 + b1 e1 + b2 e2 of a triangle, and of the origin of a ray offset from it:
/// 2 half-ulps of the greatest coordinate, and 8 of the greatest extent for the edges, the weights
/// and the triangle test, which sees the corners from where the ray starts. Of the greatest
/// component, also across it: along a ray that grazes the plane of a coordinate, the test's error
/// comes from the long axes.
DS_FN real position_error(real3 p0, real3 e1, real3 e2) {
  const real3 size =
      vec(greater(absolute(e1.x), absolute(e2.x)), greater(absolute(e1.y), absolute(e2.y)),
          greater(absolute(e1.z), absolute(e2.z)));
  const real magnitude = max_component(vec(absolute(p0.x), absolute(p0.y), absolute(p0.z)));
  return fma(max_component(size), (real)(6e-7f), magnitude * 1.2e-7f);
}

/// Turns a shading normal that faces away from the viewer (interpolation does that at silhouettes)
/// just so far that it does not: cos >= 0.01 afterwards. Continuous, so no line shows where it sets
/// in.
DS_FN real3 facing_normal(real3 shading, real3 wo) {
  const real cosine = dot(shading, wo);
  const real lift = greater(0.01f - cosine, (real)(0.0f));
  return choose(lift > 0.0f, unit(add_scaled(shading, wo, lift)), shading);
}

/// A triangle's corners: world positions, metres, and unit normals, on the side of the triangle's
/// own.
typedef struct {
  real3 position[3], normal[3];
} Corners;

/// The surface at the weights b1 and b2 of the second and third corner, seen along `wo` (unit, to
/// the viewer). u, v and colors are left at 0.
DS_FN Surface surface_at(const Corners* c, real b1, real b2, real3 wo) {
  const real3 p0 = c->position[0];
  const real3 e1 = sub(c->position[1], p0);
  const real3 e2 = sub(c->position[2], p0);
  Surface s;
  // From the first corner along the edges: far from the origin a mean of the corners would be
  // rounded several times in units of the coordinates, this is once.
  s.position = add(p0, add_scaled(scale(e1, b1), e2, b2));
  s.error = splat(position_error(p0, e1, e2));
  const real3 own = triangle_normal(e1, e2);
  s.outside = dot(own, wo) >= 0.0f;
  const real side = choose(s.outside, (real)(1.0f), (real)(-1.0f));
  s.normal = scale(own, side);
  const real3 interpolated = add_scaled(
      add_scaled(scale(c->normal[0], 1.0f - b1 - b2), c->normal[1], b1), c->normal[2], b2);
  // Grazing corner normals can cancel; the triangle's own normal stands in.
  const real3 smooth = choose(dot(interpolated, interpolated) > 1e-6f, unit(interpolated), own);
  s.shading = facing_normal(scale(smooth, side), wo);
  s.u = s.v = (real)(0.0f);
  s.b1 = b1;
  s.b2 = b2;
  s.colors = (natural)(0u);
  return s;
}
