// SPDX-License-Identifier: Apache-2.0
// What every light answers. A light KIND in lights/KIND.h has
//
//   DS_TRAITS(KIND, sum)                          of traits.h
//   LightOnHost KIND_on_host                      of traits.h, in a DS_HOOK_HOST part
//   LightSample KIND_sample(LightTables t, uint at, real3 from, real2 u)
//                                                 a way from a surface point to the light
//   real3 KIND_escape(LightTables t, uint at, real3 direction, real* pdf)
//                                                 what a path that leaves the scene meets; only
//                                                 lights beyond it have it
//
// `at` is the offset of the light's parameters in `lights`, the same in all lanes: lanes that chose
// different lights are served light by light. Pdfs are per steradian at the surface point and do
// not include the choice among lights.
#pragma once

#include "tracer/kernels/math.h"
#include "tracer/kernels/sampler.h"
#include "tracer/kernels/scene_data.h"

typedef struct {
  DS_GLOBAL float* lights;
  DS_GLOBAL float* tables;
  DS_GLOBAL float* triangles;
} LightTables;

typedef struct {
  real3 wi;         ///< unit, to the light
  real3 target;     ///< where the shadow ray ends, for bounded lights
  mask bounded;     ///< false: the light is beyond the scene
  natural covered;  ///< triangle of the target where others may lie on it (ties.cl), or k_none
  mask dirac;       ///< a point of the sphere of directions: `radiance` is irradiance at normal
                    ///< incidence, pdf is 1
  real3 radiance;
  real pdf;  ///< 0: nothing comes this way
} LightSample;

DS_FN LightSample no_light(void) {
  LightSample s;
  s.wi = vec((real)(0.0f), (real)(0.0f), (real)(1.0f));
  s.target = splat((real)(0.0f));
  s.bounded = (mask)(0);
  s.covered = (natural)(k_none);
  s.dirac = (mask)(0);
  s.radiance = splat((real)(0.0f));
  s.pdf = (real)(0.0f);
  return s;
}

DS_FN LightSample choose(mask m, LightSample a, LightSample b) {
  LightSample s;
  s.wi = choose(m, a.wi, b.wi);
  s.target = choose(m, a.target, b.target);
  s.bounded = choose_mask(m, a.bounded, b.bounded);
  s.covered = choose_natural(m, a.covered, b.covered);
  s.dirac = choose_mask(m, a.dirac, b.dirac);
  s.radiance = choose(m, a.radiance, b.radiance);
  s.pdf = choose(m, a.pdf, b.pdf);
  return s;
}

/// Index of the interval of a cumulative table that holds u: the first i with u < table[i], or the
/// last. `count` >= 1 ascending entries from `at` on. Every lane takes the same number of steps.
DS_FN natural find_interval(DS_GLOBAL float* table, natural at, uint count, real u) {
  natural low = (natural)(0u);
  // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): it tries count = 0, too
  for (uint step = 1u << (31u - leading_zeros(count)); step != 0u; step >>= 1) {
    const natural next = low + step;
    const natural entry = choose_natural(next <= count, next, (natural)(count)) - 1u;
    low = choose_natural((next <= count) & (load(table, at + entry) <= u), next, low);
  }
  return choose_natural(low < count, low, (natural)(count - 1u));
}

/// Entry i - 1 of a cumulative table, 0 for i = 0.
DS_FN real interval_start(DS_GLOBAL float* table, natural at, natural i) {
  return choose(i == 0u, (real)(0.0f), load(table, at + choose_natural(i == 0u, i, i - 1u)));
}

/// Three words, the same in all lanes.
DS_FN real3 uniform3(DS_GLOBAL float* p) {
  return vec((real)(p[0]), (real)(p[1]), (real)(p[2]));
}
