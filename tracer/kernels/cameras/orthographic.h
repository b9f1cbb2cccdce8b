// SPDX-License-Identifier: Apache-2.0
// All rays are parallel, from the plane the camera stands in: what is farther looks as large.
#pragma once

#include "tracer/kernels/camera.h"

#ifdef DS_HOOK_HOST
inline CameraShape orthographic_shape(double extent_m) {
  return {.at_camera_m = extent_m / 2};
}
inline constexpr CameraOnHost orthographic_on_host = {
    CameraSpan::extent_m,
    "0.23",
    "What the longer side of the picture shows (half of it is the largest number of LuxCore's "
    "screenwindow)",
    {.least = 0, .most = 1000000, .open_least = true},
    orthographic_shape};
#endif
