// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/manifest.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ds {

/// A model as BOP has it: millimetres, Z up, the origin in the middle of its box.
struct BopModel {
  std::vector<Vec3d> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  Vec3d middle_m;       ///< of its box, in the world
  Vec3d least, most;    ///< of the points
  double diameter = 0;  ///< largest distance between two points
};

/// Of a mesh in its file's coordinates, where the image shows it.
BopModel bop_model(const FileMesh& mesh, const ModelPose& pose);
/// ASCII PLY with normals: of the triangles around a point, weighted by area.
std::string ply_text(const BopModel& model);

/// Pixels of a picture whose centres the model covers, on a canvas three times as wide and high as the
/// picture, which is in its middle: what of it the picture cuts off is there too.
struct Silhouette {
  std::uint64_t pixels = 0;
  /// x, y of the least pixel, and greatest less least, of the picture; -1 each where there is none.
  std::array<int, 4> box{-1, -1, -1, -1};
  std::vector<std::array<int, 2>> inside;  ///< x, y of those of the picture itself
  bool whole = true;  ///< false: some of the model is behind the camera, and not counted
};
/// `to_camera` in millimetres, OpenCV axes, 3x4 row-major; `intrinsics` with pixel centres at .5.
Silhouette silhouette(const BopModel& model, const std::array<double, 12>& to_camera,
                      const std::array<double, 9>& intrinsics, int width, int height);

}  // namespace ds
