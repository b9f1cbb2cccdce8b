// SPDX-License-Identifier: Apache-2.0
// What is known of the points that a batch of rays hit.
#pragma once

#include "tracer/kernels/batch.cl"
#include "tracer/kernels/shear.h"
#include "tracer/kernels/surface.h"
#include "tracer/kernels/types.h"

/// The rows of the triangles that were hit, lane by lane; lanes are taken apart only here and in
/// batch.cl.
typedef struct {
  float word[k_triangle_words][DS_LANES] __attribute__((aligned(64)));
} LaneHits;

#if DS_LANES == 1
DS_FN void load_triangles(DS_GLOBAL float* triangles, const BatchHits* found, LaneHits* hits) {
  const uint id = found->id[0];
  DS_GLOBAL float* triangle = triangles + (id == k_none ? 0u : id) * k_triangle_words;
  for (int i = 0; i < k_triangle_words; ++i)
    hits->word[i][0] = triangle[i];
}
#else
/// Four lanes at a time, by transposing blocks of four words.
DS_FN void load_triangles(DS_GLOBAL float* triangles, const BatchHits* found, LaneHits* hits) {
  for (int lane = 0; lane < DS_LANES; lane += 4) {
    const __global float4* row[4];
    for (int i = 0; i < 4; ++i) {
      const uint id = found->id[lane + i];
      row[i] = (const __global float4*)(triangles + (id == k_none ? 0u : id) * k_triangle_words);
    }
    for (int i = 0; i < k_triangle_words / 4; ++i) {
      const float4 a = row[0][i], b = row[1][i], c = row[2][i], d = row[3][i];
      const float4 low_ab = (float4)(a.x, b.x, a.y, b.y), high_ab = (float4)(a.z, b.z, a.w, b.w);
      const float4 low_cd = (float4)(c.x, d.x, c.y, d.y), high_cd = (float4)(c.z, d.z, c.w, d.w);
      *(float4*)&hits->word[4 * i + 0][lane] = (float4)(low_ab.lo, low_cd.lo);
      *(float4*)&hits->word[4 * i + 1][lane] = (float4)(low_ab.hi, low_cd.hi);
      *(float4*)&hits->word[4 * i + 2][lane] = (float4)(high_ab.lo, high_cd.lo);
      *(float4*)&hits->word[4 * i + 3][lane] = (float4)(high_ab.hi, high_cd.hi);
    }
  }
}
#endif

DS_FN real hit_word(const LaneHits* hits, int i) {
  return *(const real*)hits->word[i];
}
DS_FN real3 hit_word3(const LaneHits* hits, int i) {
  return vec(hit_word(hits, i), hit_word(hits, i + 1), hit_word(hits, i + 2));
}

DS_FN Surface surface_of(const LaneHits* hits, real3 origin, real3 direction) {
  const real3 wo = negate(direction);
  const real3 p0 = hit_word3(hits, k_triangle_positions);
  const real3 p1 = hit_word3(hits, k_triangle_positions + 3);
  const real3 p2 = hit_word3(hits, k_triangle_positions + 6);
  const real2 weights = hit_weights(origin, direction, p0, p1, p2);
  const real b1 = weights.x;
  const real b2 = weights.y;
  const real b0 = 1.0f - b1 - b2;
  Surface s;
  const real3 e1 = sub(p1, p0);
  const real3 e2 = sub(p2, p0);
  // From the first corner along the edges: far from the origin a mean of the corners would be
  // rounded several times in units of the coordinates, this is once.
  s.position = add(p0, add_scaled(scale(e1, b1), e2, b2));
  s.error = splat(position_error(p0, e1, e2));
  const real3 own = triangle_normal(e1, e2);
  s.outside = dot(own, wo) >= 0.0f;
  const real side = choose(s.outside, (real)(1.0f), (real)(-1.0f));
  s.normal = scale(own, side);
  const real3 n0 = hit_word3(hits, k_triangle_normals);
  const real3 n1 = hit_word3(hits, k_triangle_normals + 3);
  const real3 n2 = hit_word3(hits, k_triangle_normals + 6);
  const real3 interpolated = add_scaled(add_scaled(scale(n0, b0), n1, b1), n2, b2);
  // Opposite corner normals can cancel; the triangle's own normal stands in.
  const real3 smooth = choose(dot(interpolated, interpolated) > 1e-6f, unit(interpolated), own);
  s.shading = facing_normal(scale(smooth, side), wo);
  s.u = fma(b0, hit_word(hits, k_triangle_uvs),
            fma(b1, hit_word(hits, k_triangle_uvs + 2), b2 * hit_word(hits, k_triangle_uvs + 4)));
  s.v = fma(b0, hit_word(hits, k_triangle_uvs + 1),
            fma(b1, hit_word(hits, k_triangle_uvs + 3), b2 * hit_word(hits, k_triangle_uvs + 5)));
  return s;
}
