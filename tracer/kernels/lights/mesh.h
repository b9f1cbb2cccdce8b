// SPDX-License-Identifier: Apache-2.0
// An emitting mesh: the same radiance from the front of each of its triangles, sampled uniformly
// over their area.
#pragma once

#include "tracer/kernels/light.h"

enum {
  mesh_radiance = 0,    ///< 3
  mesh_area = 3,        ///< m^2, of all triangles
  mesh_count = 4,       ///< triangles, bits of an unsigned number
  mesh_cumulative = 5,  ///< offset in tables: cumulative shares of the area
  mesh_triangles = 6    ///< offset in tables: rows of triangles, bits of unsigned numbers
};
DS_TRAITS(mesh, k_trait_sampled | k_trait_small);

/// Barycentric weights of a uniform point: Heitz 2019, "A Low-Distortion Map Between Triangle and
/// Square".
DS_FN real2 uniform_triangle(real2 u) {
  const mask lower = u.y > u.x;
  real2 b;
  b.x = choose(lower, u.x * 0.5f, u.x - u.y * 0.5f);
  b.y = choose(lower, u.y - u.x * 0.5f, u.y * 0.5f);
  return b;
}

DS_FN LightSample mesh_sample(LightTables t, uint at, real3 from, real2 u) {
  DS_GLOBAL float* p = t.lights + at;
  const uint count = as_uint(p[mesh_count]);
  DS_GLOBAL float* cumulative = t.tables + as_uint(p[mesh_cumulative]);
  const natural i = find_interval(cumulative, (natural)(0u), count, u.x);
  const real low = interval_start(cumulative, (natural)(0u), i);
  real2 v;
  v.x = lesser(clamp01((u.x - low) / greater(load(cumulative, i) - low, (real)(1e-20f))),
               (real)(0.99999994f));
  v.y = u.y;
  const real2 b = uniform_triangle(v);
  const natural triangle = load_natural(t.tables + as_uint(p[mesh_triangles]), i);
  const natural row = triangle * (uint)k_triangle_words;
  const real3 p0 = load3(t.triangles, row);
  const real3 e1 = sub(load3(t.triangles, row + 3u), p0);
  const real3 e2 = sub(load3(t.triangles, row + 6u), p0);
  LightSample s = no_light();
  const real3 normal = triangle_normal(e1, e2);
  const real3 point = add_scaled(add_scaled(p0, e1, b.x), e2, b.y);
  const real3 way = sub(point, from);
  const real squared = greater(dot(way, way), (real)(1e-20f));
  s.wi = scale(way, 1.0f / sqrt(squared));
  const real cosine = -dot(normal, s.wi);
  // Shadow rays end in front of what ties with the triangle (ties.cl).
  const natural flags = load_natural(t.triangles, row + (uint)k_triangle_flags);
  const real error = real_of(((flags >> (uint)k_tie_error_shift) & 0xffu) << 23u);
  s.target = add_scaled(point, normal, 4.0f * error);
  s.covered = choose_natural((flags & (uint)k_flag_covered) != 0u, triangle, (natural)(k_none));
  s.bounded = squared > 0.0f;
  s.radiance = uniform3(p + mesh_radiance);
  s.pdf = choose(cosine > 1e-6f, squared / (greater(cosine, (real)(1e-6f)) * p[mesh_area]),
                 (real)(0.0f));
  return s;
}
