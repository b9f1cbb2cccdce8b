// SPDX-License-Identifier: Apache-2.0
// Light that reaches the first surface by way of others and leaves it by its diffuse lobes: linear
// radiance before any tone map.
#pragma once

#include "tracer/kernels/contribution.h"

enum { indirect_diffuse_width = 3 };
DS_TRAITS(indirect_diffuse, k_plane_light | k_plane_exr);

DS_FN real3 indirect_diffuse_takes(const Contribution* c) {
  return diffuse_part(is_indirect(c), c);
}
