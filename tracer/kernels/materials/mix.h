// SPDX-License-Identifier: Apache-2.0
// One of two materials at random, the second with probability `amount`: a pure choice, made by
// resolve_choices of shade.h before any BSDF is asked, so a path pays for one of them only.
#pragma once

#include "tracer/kernels/bsdf.h"

#define DS_MIX_INPUTS(INPUT) INPUT(mix_amount, 1, 0.5f)
#define DS_MIX_NUMBERS(NUMBER)
enum { DS_MIX_INPUTS(DS_SLOT) DS_MIX_NUMBERS(DS_NUMBER_SLOT) mix_end };
enum { mix_children = 2 };
DS_TRAITS(mix, k_trait_lobes);
#ifdef DS_HOOK_HOST
inline constexpr Parameter mix_parameters[] = {{"amount", "share of material2", k_zero_to_one}};
inline constexpr NodeOnHost mix_on_host{.parameters = mix_parameters};
#endif

/// `*choice` is used up where `here`, and stretched back to [0, 1).
DS_FN natural mix_child(const real* p, mask outside, mask here, real* choice) {
  const real amount = clamp01(p[mix_amount]);
  const mask second = *choice < amount;
  const real low = choose(second, (real)(0.0f), amount);
  const real width = choose(second, amount, 1.0f - amount);
  *choice = choose(
      here, lesser((*choice - low) / greater(width, (real)(1e-10f)), (real)(0.99999994f)), *choice);
  return choose_natural(second, (natural)(1u), (natural)(0u));
}

#ifdef DS_HOOK_ALBEDO
DS_FN real mix_second(const real* p, mask outside) {
  return clamp01(p[mix_amount]);
}
#endif
