// SPDX-License-Identifier: Apache-2.0
// Light that reaches the first surface by way of others and leaves it by its glossy lobes: linear
// radiance before any tone map.
#pragma once

#include "tracer/kernels/contribution.h"

enum { indirect_glossy_width = 3 };
DS_TRAITS(indirect_glossy, k_plane_light | k_plane_exr);

DS_FN real3 indirect_glossy_takes(const Contribution* c) {
  return glossy_part(is_indirect(c), c);
}
