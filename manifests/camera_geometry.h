// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

#include <array>

namespace ds {

/// Sine and cosine of an angle in degrees, finite and within +-1e6. From + - * / only, so that the
/// bits are the same on every machine (a C library's own are not); exact at multiples of 90, else
/// within 2 ulp of a result of size 1.
double sin_deg(double degrees);
double cos_deg(double degrees);

/// Intrinsics K of a perspective camera of full angle fov_deg in (0, 180) over the longer side,
/// square pixels: row-major, in pixels, origin at the top left corner of the picture, so that the
/// first pixel's centre is (0.5, 0.5).
std::array<double, 9> camera_intrinsics(double fov_deg, int width, int height);

/// Camera-to-world 4x4, row-major, column vectors, of a camera with OpenCV axes: x right, y down, z
/// forward. World right- handed with Z up, metres. Throws Error(recipe) where the camera stands on
/// its target or looks along its `up`.
std::array<double, 16> camera_pose(const Camera& camera);

}  // namespace ds
