// SPDX-License-Identifier: Apache-2.0
// The point that is hit, x, y and z in world space, metres; 0, 0, 0 where nothing is hit.
#pragma once

#include "tracer/kernels/plane.h"

enum { position_width = 3 };
DS_TRAITS(position, k_plane_surface | k_plane_exr);

DS_FN void position_at(const HitPoint* h, real* out) {
  put_plane3(out, h->surface.position);
}
