// SPDX-License-Identifier: Apache-2.0
// The unit normal that materials are lit by, in world space, on the side that is seen (PNG: -1 to 1 in
// the whole range); 0, 0, 0 where nothing is hit, in PNG too. It never faces away from the viewer.
#pragma once

#include "tracer/kernels/plane.h"

enum { shading_normal_width = 3 };
DS_TRAITS(shading_normal, k_plane_surface | k_plane_normals | k_plane_exr | k_plane_png_signed);

DS_FN void shading_normal_at(const HitPoint* h, real* out) {
  put_plane3(out, h->surface.shading);
}
