// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/plan.h"
#include "manifests/concerns.h"
#include "manifests/manifest.h"

#include <filesystem>
#include <vector>

namespace ds {

/// Every kind of Concern, counted for the images that a manifest lists; `planned` is
/// Plan::concerns.
std::vector<Concern> dataset_concerns(const Recipe& recipe, const std::vector<Concern>& planned,
                                      const std::vector<ImageRecord>& images);

/// Counts the pixels of an image's files, read from the dataset's folder, where the dsbuild that
/// made them did not, and keeps the counts in the database: once for each image. How many are
/// clipped the picture does not tell any more: `white` stays absent.
void count_older_pixels(ImageRecord& record, const PlannedImage& image,
                        const std::filesystem::path& folder, Database& database);

}  // namespace ds
