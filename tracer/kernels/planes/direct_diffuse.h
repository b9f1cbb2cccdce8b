// SPDX-License-Identifier: Apache-2.0
// Light that reaches the first surface straight from lamps and sky and leaves it by its diffuse lobes
// (matte, the base of glossy2): linear radiance before any tone map.
#pragma once

#include "tracer/kernels/contribution.h"

enum { direct_diffuse_width = 3 };
DS_TRAITS(direct_diffuse, k_plane_light | k_plane_exr);

DS_FN real3 direct_diffuse_takes(const Contribution* c) {
  return diffuse_part(is_direct(c), c);
}
