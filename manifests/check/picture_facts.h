// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/check/depth_facts.h"
#include "manifests/manifest.h"
#include "tracer/render/image_files.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// What is looked for in a picture's pixels. Values are those stored, over the greatest of their
/// type: developed pictures, from 0 to 1.
struct PictureFacts {
  static constexpr int k_side = 16;
  /// Means over a grid of k_side x k_side equal parts, three channels, row by row.
  std::array<float, std::size_t{3} * k_side * k_side> thumbnail{};
  /// Bit 8 y + x: whether of 9 x 8 parts the one at (x + 1, y) is lighter than that at (x, y). Pictures
  /// that look alike differ in few bits (Krawetz, "Kind of like that", 2013).
  std::uint64_t gradient = 0;
  std::uint64_t pixels = 0;
  /// Those lighter than the third lightest of their 5 x 5 by k_speck and more: single ones and pairs.
  std::uint64_t specks = 0;
  static constexpr double k_speck = 0.15;
  /// Mean over places where the mask's edge crosses a row or a column of the largest channel's
  /// |a - b|, one pixel inside the edge and one outside; absent where there is no edge or no mask.
  std::optional<double> edge_contrast{};
};

/// `mask`: of the same size, one channel, 0 where the model is not seen; or nothing.
PictureFacts facts_of(const DecodedImage& picture, const DecodedImage* mask);

/// Whether the root mean square of the differences of two thumbnails is `distance` at most.
bool are_alike(const PictureFacts& a, const PictureFacts& b, double distance);

/// Of each image what its files tell.
struct FileFacts {
  std::vector<std::optional<PictureFacts>> pictures;  ///< absent where it has no picture
  std::vector<std::optional<DepthFacts>> depths;      ///< absent where no depth, mask or pose
};

/// On all processors; nothing of an image whose files cannot be read, which `failed` is told with the
/// reason. `done` may be called from any thread, one at a time.
FileFacts read_file_facts(const std::filesystem::path& folder,
                          const std::vector<ImageRecord>& images,
                          const std::function<void(const std::string& why)>& failed,
                          const std::function<void(std::uint64_t done, std::uint64_t all)>& done);

}  // namespace ds
