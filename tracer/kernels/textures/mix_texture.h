// SPDX-License-Identifier: Apache-2.0
// From texture1 (amount 0) to texture2 (amount 1); amount is held in [0, 1].
#pragma once

#include "tracer/kernels/texture.h"

#define DS_MIX_TEXTURE_INPUTS(INPUT) \
  INPUT(mix_texture_amount, 1, 0.5f) \
  INPUT(mix_texture_texture1, 3, 0.0f) INPUT(mix_texture_texture2, 3, 1.0f)
#define DS_MIX_TEXTURE_NUMBERS(NUMBER)
enum { DS_MIX_TEXTURE_INPUTS(DS_INPUT_INDEX) mix_texture_inputs };
DS_TRAITS(mix_texture, 0);
#ifdef DS_HOOK_HOST
inline MaybeBounds mix_texture_bounds(std::span<const MaybeBounds> inputs, const float* numbers) {
  return mixed_bounds(inputs[mix_texture_amount], inputs[mix_texture_texture1],
                      inputs[mix_texture_texture2]);
}
inline constexpr Parameter mix_texture_parameters[] = {{"amount", "of texture2", k_zero_to_one},
                                                       {"texture1", "what there is at amount 0"},
                                                       {"texture2", "what there is at amount 1"}};
inline constexpr NodeOnHost mix_texture_on_host{.parameters = mix_texture_parameters,
                                                .bounds = mix_texture_bounds};
#endif

DS_FN real3 mix_texture_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs) {
  return lerp3(inputs[mix_texture_texture1], inputs[mix_texture_texture2],
               clamp01(inputs[mix_texture_amount].x));
}
