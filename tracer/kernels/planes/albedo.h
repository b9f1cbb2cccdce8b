// SPDX-License-Identifier: Apache-2.0
// The surface's colour, linear red, green and blue: what share of white light falling straight onto it
// its material reflects or lets through, textures and all; of a mix, the mean of its parts. A matte's
// is its kd. Neither light nor angle of view is in it, as denoisers want it; 0, 0, 0 where nothing is
// hit. PNG: linear, [0, 1] in the whole range.
#pragma once

#include "tracer/kernels/plane.h"

enum { albedo_width = 3 };
DS_TRAITS(albedo, k_plane_surface | k_plane_materials | k_plane_exr | k_plane_png_share);

DS_FN void albedo_at(const HitPoint* h, real* out) {
  put_plane3(out, h->albedo);
}
