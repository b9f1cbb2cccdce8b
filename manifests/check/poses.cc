// SPDX-License-Identifier: Apache-2.0
// What is seen of a model where its pose and the camera say that it cannot be.
#include "manifests/check/check.h"
#include "manifests/check/depth_facts.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace ds {
namespace {

struct Rectangle {
  double left = std::numeric_limits<double>::infinity(), above = left, right = -left, below = -left;
};

/// Around the box's corners in the picture; nothing where one is not before the camera.
std::optional<Rectangle> around_model(const ImageRecord& image) {
  Rectangle around;
  for (const Vec3d corner : corners_of(*image.pose)) {
    const Vec3d at = pixel_of(image, corner);
    if (!(at.z > 0)) return std::nullopt;
    around.left = std::min(around.left, at.x);
    around.right = std::max(around.right, at.x);
    around.above = std::min(around.above, at.y);
    around.below = std::max(around.below, at.y);
  }
  return around;
}

void check_poses(const CheckInput& input, CheckReport& report) {
  // A mask has pixels whose middle shows the model; floats round.
  constexpr double k_margin = 0.5;
  std::vector<std::string> outside;
  std::uint64_t looked_at = 0;
  for (const ImageRecord& image : input.images) {
    const PixelCounts& counts = image.pixel_counts;
    if (!image.pose || !counts.model || *counts.model == 0 || !counts.left || !counts.right ||
        !counts.above || !counts.below)
      continue;
    if (!image.intrinsics && !image.metres_per_pixel) continue;
    const auto around = around_model(image);
    if (!around) continue;
    ++looked_at;
    const double left = static_cast<double>(*counts.left) + 0.5,
                 above = static_cast<double>(*counts.above) + 0.5,
                 right = image.width - static_cast<double>(*counts.right) - 0.5,
                 below = image.height - static_cast<double>(*counts.below) - 0.5;
    if (left < around->left - k_margin || right > around->right + k_margin ||
        above < around->above - k_margin || below > around->below + k_margin)
      outside.push_back(image.id);
  }
  report.add(CheckLevel::error,
             "masks show their model outside of the box that its pose and camera give", outside,
             looked_at, "mask and manifest are not of one picture: dsbuild verify");
}

}  // namespace

Check poses_check() {
  return {"poses", "masks outside of where pose and camera say that the model is", check_poses};
}

}  // namespace ds
