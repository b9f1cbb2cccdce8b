// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ds {

using Corners = std::array<Vec3, 3>;

/// A bumpy ball of 50,700 triangles (radius about 1) on a ground plane 40 wide. The same on every
/// run.
std::vector<Corners> ray_scene();

/// As the kernels read rays: origin, direction, greatest distance.
using RayWords = std::array<float, 7>;

/// One ray a pixel of a square picture that shows the ball, row by row.
std::vector<RayWords> camera_rays(int size);

/// Where a ray met what.
struct Met {
  float t = 0;
  std::uint32_t triangle = 0;
  bool any = false;
};

/// From each hit one ray, cosine-distributed about the face's normal on the side it was met from:
/// neighbours go different ways. Shorter than `rays` by those that met nothing.
std::vector<RayWords> bounce_rays(const std::vector<Corners>& triangles,
                                  const std::vector<RayWords>& rays, const std::vector<Met>& met);

}  // namespace ds
