// SPDX-License-Identifier: Apache-2.0
// How much of the pixel is covered: the share of its samples, through lens and filter, whose ray meets
// something; 0 where only what lies infinitely far is seen (PNG: 0 to 1 in the whole range). Of the samples
// of the picture. Colours that are premultiplied by it are the plane foreground.
#pragma once

#include "tracer/kernels/contribution.h"

enum { alpha_width = 1 };
DS_TRAITS(alpha,
          k_plane_light | k_plane_beside | k_plane_coverage | k_plane_exr | k_plane_png_share);

DS_FN real3 alpha_takes(const Contribution* c) {
  return splat((real)(0.0f));
}
