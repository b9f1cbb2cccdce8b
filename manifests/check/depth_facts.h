// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/manifest.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace ds {

/// What an image shows, read from its files: row by row.
struct DepthView {
  const ImageRecord* record = nullptr;  ///< with a pose
  std::vector<float> depth;             ///< planar z in metres, 0 where nothing is hit
  std::vector<std::uint8_t> mask;       ///< 0 where the model is not seen
};

/// Whether an image's depths are where its manifest says that its model is, in pixels.
struct DepthFacts {
  std::uint64_t shown = 0;      ///< of the mask
  std::uint64_t elsewhere = 0;  ///< of these, whose depth is no place in the box around the model
  std::uint64_t compared = 0;   ///< places of some of them, which the other image looks at
  std::uint64_t missed = 0;     ///< of these, behind which the other sees
};

/// The point that a depth at a pixel's middle is, in the world; and where a point of the world is in the
/// picture: x and y in pixels, and its depth.
Vec3d point_at(const ImageRecord& record, int x, int y, double depth);
Vec3d pixel_of(const ImageRecord& record, Vec3d point);
/// The eight corners of the box around the model, in the world.
std::array<Vec3d, 8> corners_of(const ModelPose& pose);

/// `other`: another image of the model at the same place, or none. A place is compared where the other
/// image must show it or what hides it: 3 x 3 pixels around it show one flat piece of the model, and that
/// piece covers the middle of the other image's pixel there, which what is thin or seen from its edge need
/// not. It is missed where the other sees farther in all 3 x 3 pixels around it, by more than a hundredth of
/// the model's size. Of about 1,000 places it is asked.
DepthFacts depth_facts(const DepthView& own, const DepthView* other);

}  // namespace ds
