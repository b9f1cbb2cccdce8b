// SPDX-License-Identifier: Apache-2.0
// The mask that the model alone would have, as if nothing stood before it: 1 (255 in PNG) where the
// ray through the pixel's centre and the pinhole meets it at all, else 0.
#pragma once

#include "tracer/kernels/plane.h"

enum { amodal_mask_width = 1 };
DS_TRAITS(amodal_mask, k_plane_png_share | k_plane_alone);

DS_FN void amodal_mask_at(const HitPoint* h, real* out) {
  out[0] = choose(h->object == k_model_object, (real)(1.0f), (real)(0.0f));
}
