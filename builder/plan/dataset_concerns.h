// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/plan.h"
#include "manifests/concerns.h"
#include "manifests/manifest.h"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace ds {

/// What of an image that a manifest lists is counted for the dataset as a whole. Views what others
/// hold.
struct ImageFacts {
  std::string_view id, model, class_path, split;
  std::uint64_t pixels = 0;  ///< width times height
  PixelCounts counts{};
};

/// Every kind of Concern, counted for the images that a manifest lists; `planned` is
/// Plan::concerns. A class or split that an image of `pending` is of, which is to come, is not empty.
std::vector<Concern> dataset_concerns(const Recipe& recipe, const std::vector<Concern>& planned,
                                      const std::vector<ImageFacts>& images,
                                      const std::vector<ImageFacts>& pending = {});

/// Counts the pixels of an image's files, read from the dataset's folder, where the dsbuild that
/// made them did not, and keeps the counts in the database: once for each image. How many are
/// clipped the picture does not tell any more: `white` stays absent.
void count_older_pixels(ImageRecord& record, const PlannedImage& image,
                        const std::filesystem::path& folder, Database& database);

}  // namespace ds
