// SPDX-License-Identifier: Apache-2.0
#include "manifests/model_pose.h"

#include <algorithm>
#include <cstddef>

namespace ds {

Box world_box(const ModelPose& pose) {
  const auto& m = pose.model_to_world;
  const auto moved = [&](Vec3d p) {
    const auto row = [&](std::size_t r) {
      return m[r] * p.x + m[r + 1] * p.y + m[r + 2] * p.z + m[r + 3];
    };
    return Vec3d{row(0), row(4), row(8)};
  };
  const Box& box = pose.model_box;
  const Vec3d first = moved(box.least);
  Box around{first, first};
  for (const double x : {box.least.x, box.most.x})
    for (const double y : {box.least.y, box.most.y})
      for (const double z : {box.least.z, box.most.z}) {
        const Vec3d p = moved({x, y, z});
        around = {{std::min(around.least.x, p.x), std::min(around.least.y, p.y),
                   std::min(around.least.z, p.z)},
                  {std::max(around.most.x, p.x), std::max(around.most.y, p.y),
                   std::max(around.most.z, p.z)}};
      }
  return around;
}

std::array<double, 16> model_to_camera(const ModelPose& pose,
                                       const std::array<double, 16>& camera_to_world) {
  // The inverse of a rotation is its transpose.
  const auto& c = camera_to_world;
  const auto& m = pose.model_to_world;
  std::array<double, 16> product{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k)
        sum += c[4 * k + row] * (m[4 * k + column] - (column == 3 ? c[4 * k + 3] : 0.0));
      product[4 * row + column] = sum;
    }
  }
  product[15] = 1;
  return product;
}

std::array<double, 16> to_opengl(std::array<double, 16> to_opencv) {
  for (std::size_t i = 4; i < 12; ++i)
    to_opencv[i] = -to_opencv[i];
  return to_opencv;
}

}  // namespace ds
