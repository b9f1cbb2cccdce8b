// SPDX-License-Identifier: Apache-2.0
#include "manifests/camera_geometry.h"

#include "tracer/base/error.h"
#include "tracer/base/vec.h"

#include <algorithm>
#include <cmath>

namespace ds {
std::array<double, 9> camera_intrinsics(double fov_deg, int width, int height) {
  const double half = std::max(width, height) / 2.0;
  const double focal = half * cos_deg(fov_deg / 2) / sin_deg(fov_deg / 2);
  return {focal, 0, width / 2.0, 0, focal, height / 2.0, 0, 0, 1};
}

std::array<double, 16> camera_pose(const Camera& camera) {
  const Vec3d forward = normalized(camera.target - camera.position);
  const Vec3d right = normalized(cross(forward, camera.up));
  if (!(length(right) > 0.5)) {
    fail(ErrorKind::recipe,
         "a camera must look away from its position and not along its up vector, got position "
         "({}, {}, {})",
         camera.position.x, camera.position.y, camera.position.z);
  }
  const Vec3d down = cross(forward, right);
  const Vec3d& p = camera.position;
  return {right.x, down.x, forward.x, p.x, right.y, down.y, forward.y, p.y,
          right.z, down.z, forward.z, p.z, 0,       0,      0,         1};
}

}  // namespace ds
