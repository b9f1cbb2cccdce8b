// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/degrees.h"
#include "tracer/scene/scene.h"

#include <array>

namespace ds {

/// Intrinsics K of a perspective camera of full angle fov_deg in (0, 180) over the longer side,
/// square pixels: row-major, in pixels, origin at the top left corner of the picture, so that the
/// first pixel's centre is (0.5, 0.5).
std::array<double, 9> camera_intrinsics(double fov_deg, int width, int height);

/// Camera-to-world 4x4, row-major, column vectors, of a camera with OpenCV axes: x right, y down, z
/// forward. World right- handed with Z up, metres. Throws Error(recipe) where the camera stands on
/// its target or looks along its `up`.
std::array<double, 16> camera_pose(const Camera& camera);

}  // namespace ds
