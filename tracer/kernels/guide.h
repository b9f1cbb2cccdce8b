// SPDX-License-Identifier: Apache-2.0
// Where the light of caustics comes from: directions that the surfaces they fall on would hardly
// ever sample, though much comes from there (Jensen 1995, "Importance Driven Path Tracing using the
// Photon Map"). A grid of cells around the model holds for each up to k_guide_lobes
// spheres, made of photons (render/guide.h). A share of the directions that paths leave by is
// drawn towards these, with both ways' densities added up, so the picture's mean is the same
// whatever the spheres are.
#pragma once

#include "tracer/kernels/guide_data.h"
#include "tracer/kernels/math.h"
#include "tracer/kernels/sampler.h"

/// Share of directions that are drawn towards the spheres, where there are any.
#define k_guide_share 0.25f

/// A lobe is the cone that its sphere is seen in, half of all directions at most.
typedef struct {
  real3 axis;    ///< unit, to the sphere's centre
  real cosine;   ///< of the cone's half angle
  real cap;      ///< 1 - cosine, without cancellation
  real weight;   ///< share of the lobe among all
  real density;  ///< weight per steradian of the cone
} GuideLobe;

/// What a point looks to. Without `there` in any lane the lobes are not set.
typedef struct {
  mask there;  ///< there is some
  GuideLobe lobes[k_guide_lobes];
} Guide;

DS_FN GuideLobe guide_lobe(DS_GLOBAL float* guide, natural at, real3 position) {
  const real3 way = sub(load3(guide, at), position);
  const real squared = greater(dot(way, way), (real)(1e-30f));
  GuideLobe lobe;
  lobe.axis = scale(way, 1.0f / sqrt(squared));
  const real sin2 = lesser(load(guide, at + (uint)k_guide_radius2) / squared, (real)(1.0f));
  lobe.cosine = safe_sqrt(1.0f - sin2);
  lobe.cap = greater(sin2 / (1.0f + lobe.cosine), (real)(1e-9f));
  lobe.weight = load(guide, at + (uint)k_guide_weight);
  lobe.density = lobe.weight * DS_INV_TWO_PI / lobe.cap;
  return lobe;
}

/// For the points in `wanted`.
DS_FN Guide guide_at(DS_GLOBAL float* guide, mask wanted, real3 position) {
  const uint side = as_uint(guide[k_guide_side]);
  const real cells = (real)((float)side);
  const real3 low = vec((real)(guide[k_guide_origin]), (real)(guide[k_guide_origin + 1]),
                        (real)(guide[k_guide_origin + 2]));
  const real3 at = scale(sub(position, low), (real)(guide[k_guide_per_metre]));
  const mask inside = wanted & (at.x >= 0.0f) & (at.x < cells) & (at.y >= 0.0f) & (at.y < cells) &
                      (at.z >= 0.0f) & (at.z < cells);
  Guide g;
  g.there = inside;
  if (!any_lane(inside)) return g;
  const real3 held = choose(inside, at, splat((real)(0.0f)));
  const natural cell = (to_natural(held.z) * side + to_natural(held.y)) * side + to_natural(held.x);
  natural lobes = load_natural(guide, cell + (uint)k_guide_cells);
  g.there = inside & (lobes != 0u);
  if (!any_lane(g.there)) return g;
  lobes = choose_natural(g.there, lobes, (natural)((uint)k_guide_nowhere));
  for (uint i = 0; i < (uint)k_guide_lobes; ++i)
    g.lobes[i] = guide_lobe(guide, lobes + i * (uint)k_guide_lobe_words, position);
  return g;
}

/// Density of `wi` (unit, world) among directions towards the spheres, per steradian.
DS_FN real guide_pdf(const Guide* g, real3 wi) {
  real sum = (real)(0.0f);
  for (uint i = 0; i < (uint)k_guide_lobes; ++i) {
    const mask inside = dot(g->lobes[i].axis, wi) >= g->lobes[i].cosine;
    sum = sum + choose(inside, g->lobes[i].density, (real)(0.0f));
  }
  return sum;
}

/// A direction towards one of the spheres, chosen by `choice` in [0, 1).
DS_FN real3 guide_sample(const Guide* g, real choice, real2 u) {
  real3 axis = g->lobes[0].axis;
  real cap = g->lobes[0].cap, low = g->lobes[0].weight;
  for (uint i = 1; i < (uint)k_guide_lobes; ++i) {
    const mask here = (choice >= low) & (g->lobes[i].weight > 0.0f);
    axis = choose(here, g->lobes[i].axis, axis);
    cap = choose(here, g->lobes[i].cap, cap);
    low = low + g->lobes[i].weight;
  }
  const real below = u.x * cap;  // 1 - cosine
  const real sine = safe_sqrt(below * (2.0f - below));
  const SinCos phi = sin_cos_turns(u.y);
  return unit(to_world(frame_around(axis), vec(sine * phi.cos, sine * phi.sin, 1.0f - below)));
}
