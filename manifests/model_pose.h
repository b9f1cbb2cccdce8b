// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"
#include "tracer/scene/mesh.h"

#include <array>

namespace ds {

/// Where the model of an image stands.
struct ModelPose {
  /// The model file's coordinates to the world: turned, scaled to metres, moved. 4x4, row-major, column vectors.
  std::array<double, 16> model_to_world{};
  Box model_box;  ///< around the model, in its file's coordinates

  bool operator==(const ModelPose&) const = default;
};

/// The least box of the world's axes around `model_box`, metres: where the model is turned by multiples of 90
/// degrees that around the model itself.
Box world_box(const ModelPose& pose);

/// The model file's coordinates to a camera of OpenCV axes (x right, y down, z forward), metres; 4x4,
/// row-major, with the scale. `camera_to_world` as camera_pose gives it.
std::array<double, 16> model_to_camera(const ModelPose& pose,
                                       const std::array<double, 16>& camera_to_world);
/// A matrix to a camera of OpenCV axes as one to OpenGL's: x right, y up, z backward.
std::array<double, 16> to_opengl(std::array<double, 16> to_opencv);

}  // namespace ds
