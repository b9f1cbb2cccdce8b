// SPDX-License-Identifier: Apache-2.0
// Distance from the camera's pinhole in metres (PNG: millimetres, up to 65.535 m), 0 where nothing is
// hit. LuxCore calls it DEPTH.
#pragma once

#include "tracer/kernels/plane.h"

enum { distance_width = 1 };
DS_TRAITS(distance, k_plane_exr | k_plane_png_milli);

DS_FN void distance_at(const HitPoint* h, real* out) {
  out[0] = h->distance;
}
