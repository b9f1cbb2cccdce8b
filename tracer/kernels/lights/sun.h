// SPDX-License-Identifier: Apache-2.0
// A disc at infinity of uniform radiance.
#pragma once

#include "tracer/kernels/light.h"

enum {
  sun_radiance = 0,   ///< 3
  sun_direction = 3,  ///< 3: unit, towards the sun
  sun_tangent = 6,    ///< 3: with the next, a frame around the direction
  sun_bitangent = 9,  ///< 3
  sun_one_minus_cos =
      12,  ///< 1 - cos of the angular radius: kept as such, a cosine near 1 has few bits of it
  sun_sin2 = 13,  ///< squared sine of the angular radius
  sun_pdf = 14    ///< 1 / solid angle
};
DS_TRAITS(sun, k_trait_beyond | k_trait_sampled | k_trait_small);

DS_FN LightSample sun_sample(LightTables t, uint at, real3 from, real2 u) {
  DS_GLOBAL float* p = t.lights + at;
  const real one_minus_cos = u.x * p[sun_one_minus_cos];
  const real sine = safe_sqrt(one_minus_cos * (2.0f - one_minus_cos));
  const SinCos phi = sin_cos_turns(u.y);
  LightSample s = no_light();
  const real3 along = scale(uniform3(p + sun_direction), 1.0f - one_minus_cos);
  s.wi = unit(add_scaled(add_scaled(along, uniform3(p + sun_tangent), sine * phi.cos),
                         uniform3(p + sun_bitangent), sine * phi.sin));
  s.radiance = uniform3(p + sun_radiance);
  s.pdf = (real)(p[sun_pdf]);
  return s;
}

DS_FN real3 sun_escape(LightTables t, uint at, real3 direction, real* pdf) {
  DS_GLOBAL float* p = t.lights + at;
  const real x = dot(direction, uniform3(p + sun_tangent));
  const real y = dot(direction, uniform3(p + sun_bitangent));
  const real z = dot(direction, uniform3(p + sun_direction));
  const mask in_disc = (x * x + y * y <= p[sun_sin2]) & (z > 0.0f);
  *pdf = choose(in_disc, (real)(p[sun_pdf]), (real)(0.0f));
  return choose(in_disc, uniform3(p + sun_radiance), splat((real)(0.0f)));
}
