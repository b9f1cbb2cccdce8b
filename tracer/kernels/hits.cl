// SPDX-License-Identifier: Apache-2.0
// What is known of the points that a batch of rays hit.
#pragma once

#include "tracer/kernels/batch.cl"
#include "tracer/kernels/scene_data.h"
#include "tracer/kernels/shear.h"
#include "tracer/kernels/surface.h"

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

DS_FN Corners corners_of(const LaneHits* hits) {
  Corners c;
  for (int i = 0; i < 3; ++i) {
    c.position[i] = hit_word3(hits, k_triangle_positions + 3 * i);
    c.normal[i] = hit_word3(hits, k_triangle_normals + 3 * i);
  }
  return c;
}

DS_FN Surface surface_of(const LaneHits* hits, real3 origin, real3 direction) {
  const Corners c = corners_of(hits);
  const real2 weights = hit_weights(origin, direction, c.position[0], c.position[1], c.position[2]);
  const real b1 = weights.x;
  const real b2 = weights.y;
  const real b0 = 1.0f - b1 - b2;
  Surface s = surface_at(&c, b1, b2, negate(direction));
  // Rays off a surface must clear what ties with it, unless both are where floats say exactly.
  const natural flags = bits_of(hit_word(hits, k_triangle_flags));
  s.error = choose((flags & (uint)k_flag_tie_rounded) != 0u,
                   splat(real_of(((flags >> (uint)k_tie_error_shift) & 0xffu) << 23u)), s.error);
  s.u = fma(b0, hit_word(hits, k_triangle_uvs),
            fma(b1, hit_word(hits, k_triangle_uvs + 2), b2 * hit_word(hits, k_triangle_uvs + 4)));
  s.v = fma(b0, hit_word(hits, k_triangle_uvs + 1),
            fma(b1, hit_word(hits, k_triangle_uvs + 3), b2 * hit_word(hits, k_triangle_uvs + 5)));
  return s;
}
