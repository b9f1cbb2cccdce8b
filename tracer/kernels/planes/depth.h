// SPDX-License-Identifier: Apache-2.0
// Planar z along the camera's z axis in metres (PNG: millimetres, up to 65.535 m), 0 where nothing is
// hit.
#pragma once

#include "tracer/kernels/plane.h"

enum { depth_width = 1 };
DS_TRAITS(depth, k_plane_exr | k_plane_png_milli);

DS_FN void depth_at(const HitPoint* h, real* out) {
  out[0] = h->depth;
}
