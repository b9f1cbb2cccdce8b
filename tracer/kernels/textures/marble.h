// SPDX-License-Identifier: Apache-2.0
// Marble: veins where sin(y + variation fbm) is near its turning points (after Perlin 1985). The
// colours are our own; position, scale, octaves, roughness and variation mean what they mean in
// LuxCore.
#pragma once

#include "tracer/kernels/noise.h"
#include "tracer/kernels/texture.h"

#define DS_MARBLE_INPUTS(INPUT)
#define DS_MARBLE_NUMBERS(NUMBER) \
  NUMBER(marble_octaves, 8.0f)    \
  NUMBER(marble_roughness, 0.5f) NUMBER(marble_scale, 1.0f) NUMBER(marble_variation, 0.2f)
enum { DS_MARBLE_NUMBERS(DS_NUMBER_INDEX) marble_numbers };
enum { marble_inputs = 0 };
DS_TRAITS(marble, k_trait_position);
#ifdef DS_HOOK_HOST
inline MaybeBounds marble_bounds(std::span<const MaybeBounds> inputs, const float* numbers) {
  return bounds_from_to(0, 1, false);
}
inline constexpr Parameter marble_parameters[] = {
    {"octaves", "of noise, each finer by 1.99", {.least = 0, .most = 32}, ParameterKind::whole},
    {"roughness", "weight of each octave, of the one before", {.least = -10, .most = 10}},
    {"scale", "factor on the point"},
    {"variation", "weight of the noise beside y"}};
inline constexpr NodeOnHost marble_on_host{.parameters = marble_parameters,
                                           .bounds = marble_bounds};
#endif

/// The stone's colour at t in [0, 1]: pale, with a bluish vein around 0.92 and a faint grey one
/// around 0.42.
DS_FN real3 marble_colour(real t) {
  const real vein = absolute(t - 0.92f) * 6.5f;
  const real faint = absolute(t - 0.42f) * 5.0f;
  const real dark = square(clamp01(1.0f - vein));
  const real grey = square(clamp01(1.0f - faint));
  const real3 pale = vec((real)(0.87f), (real)(0.86f), (real)(0.87f));
  const real3 with_grey = lerp3(pale, splat((real)(0.72f)), grey);
  return lerp3(with_grey, vec((real)(0.29f), (real)(0.29f), (real)(0.46f)), dark);
}

DS_FN real3 marble_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs) {
  const real3 p = scale(at.position, (real)(numbers[marble_scale]));
  const real noise =
      fractal_noise(p, (real)(numbers[marble_roughness]), (int)numbers[marble_octaves]);
  const real phase = fma((real)(numbers[marble_variation]), noise, p.y);
  return marble_colour(fma(sine(phase), (real)(0.5f), (real)(0.5f)));
}
