// SPDX-License-Identifier: Apache-2.0
// All that the first surface shows as a mirror or smooth glass, lamps and sky among it: linear radiance
// before any tone map.
#pragma once

#include "tracer/kernels/contribution.h"

enum { indirect_specular_width = 3 };
DS_TRAITS(indirect_specular, k_plane_light | k_plane_exr);

DS_FN real3 indirect_specular_takes(const Contribution* c) {
  return all_of((c->scatterings > 0u) & c->specular);
}
