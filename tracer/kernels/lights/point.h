// SPDX-License-Identifier: Apache-2.0
// A point that shines equally in all directions.
#pragma once

#include "tracer/kernels/light.h"

enum { point_intensity = 0 /* 3: W/sr */, point_position = 3 /* 3: metres */ };
DS_TRAITS(point, k_trait_sampled | k_trait_small);

/// Inverse square law. Closer than 1e-10 m the distance counts as 1e-10 m.
DS_FN LightSample point_sample(LightTables t, uint at, real3 from, real2 u) {
  DS_GLOBAL float* p = t.lights + at;
  LightSample s = no_light();
  s.target = uniform3(p + point_position);
  const real3 way = sub(s.target, from);
  const real squared = greater(dot(way, way), (real)(1e-20f));
  s.wi = scale(way, 1.0f / sqrt(squared));
  s.bounded = s.dirac = squared > 0.0f;
  s.radiance = scale(uniform3(p + point_intensity), 1.0f / squared);
  s.pdf = (real)(1.0f);
  return s;
}
