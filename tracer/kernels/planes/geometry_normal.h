// SPDX-License-Identifier: Apache-2.0
// The facet's unit normal in world space, on the side that is seen (PNG: -1 to 1 in the whole range);
// 0, 0, 0 where nothing is hit, in PNG too.
#pragma once

#include "tracer/kernels/plane.h"

enum { geometry_normal_width = 3 };
DS_TRAITS(geometry_normal, k_plane_surface | k_plane_exr | k_plane_png_signed);

DS_FN void geometry_normal_at(const HitPoint* h, real* out) {
  put_plane3(out, h->surface.normal);
}
