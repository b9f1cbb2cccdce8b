// SPDX-License-Identifier: Apache-2.0
// What the camera sees shine by itself, lamps and sky: linear radiance before any tone map. With the
// planes direct_diffuse, direct_glossy, indirect_diffuse, indirect_glossy and indirect_specular it adds
// up to the picture.
#pragma once

#include "tracer/kernels/contribution.h"

enum { emission_width = 3 };
DS_TRAITS(emission, k_plane_light | k_plane_exr);

DS_FN real3 emission_takes(const Contribution* c) {
  return all_of(c->scatterings == 0u);
}
