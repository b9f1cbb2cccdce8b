// SPDX-License-Identifier: Apache-2.0
// Light that reaches the first surface straight from lamps and sky and leaves it by its glossy lobes
// (metal2, roughglass, the coat of glossy2), through it too: linear radiance before any tone map.
#pragma once

#include "tracer/kernels/contribution.h"

enum { direct_glossy_width = 3 };
DS_TRAITS(direct_glossy, k_plane_light | k_plane_exr);

DS_FN real3 direct_glossy_takes(const Contribution* c) {
  return glossy_part(is_direct(c), c);
}
