// SPDX-License-Identifier: Apache-2.0
// Where the ray through the pixel's centre and the pinhole meets the model first: 1 (255 in PNG),
// else 0.
#pragma once

#include "tracer/kernels/plane.h"

enum { mask_width = 1 };
DS_TRAITS(mask, k_plane_png_share);

DS_FN void mask_at(const HitPoint* h, real* out) {
  out[0] = choose(h->object == k_model_object, (real)(1.0f), (real)(0.0f));
}
