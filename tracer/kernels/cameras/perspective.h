// SPDX-License-Identifier: Apache-2.0
// All rays of a pinhole, or a pixel's rays of a lens, pass one point: what is farther looks smaller.
#pragma once

#include "tracer/kernels/camera.h"

#ifdef DS_HOOK_HOST
inline CameraShape perspective_shape(double fov_deg) {
  return {.per_metre = tan_half(fov_deg)};
}
inline constexpr CameraOnHost perspective_on_host = {
    CameraSpan::fov_deg,
    "49",
    "Full angle of view over the longer side of the picture",
    {.least = 0, .most = 180, .open_least = true, .open_most = true},
    perspective_shape};
#endif
