// SPDX-License-Identifier: Apache-2.0
// The picture without what is seen of lights infinitely far (skies, HDRIs), which light it all the same:
// linear radiance before any tone map, premultiplied by the plane alpha. Over another background b it is
// foreground + (1 - alpha) b. As rgba8 a picture on a transparent background: developed as the image is, but
// for the camera's effects, and with straight alpha.
#pragma once

#include "tracer/kernels/contribution.h"

enum { foreground_width = 3 };
DS_TRAITS(foreground, k_plane_light | k_plane_beside | k_plane_exr | k_plane_cut_out);

DS_FN real3 foreground_takes(const Contribution* c) {
  return all_of(!c->beyond);
}
