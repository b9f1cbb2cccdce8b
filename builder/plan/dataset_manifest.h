// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/dataset_concerns.h"
#include "builder/plan/plan.h"
#include "builder/store/disk.h"
#include "manifests/manifest.h"

#include <map>
#include <string>
#include <vector>

namespace ds {

/// The version that manifests and `--version` name.
std::string program_version();

/// Of a class of the plan; nothing of "".
std::optional<std::uint64_t> class_id_of(const Plan& plan, const std::string& class_path);

/// What the recipe drew for an image, and for some.
DrawRecords draws_of(const ImageSpec& image, const Recipe& recipe);
/// How often they were drawn; nothing where the recipe rejects none.
std::optional<std::uint64_t> attempts_of(const ImageSpec& image, const Recipe& recipe);
DrawSummaries summaries_of(const Recipe& recipe, const std::vector<const ImageSpec*>& images);

/// The manifest's line for an image whose files are in place. Throws Error(io) where the database
/// does not know one.
ImageRecord image_record(const PlannedImage& image, const Recipe& recipe, const Plan& plan,
                         Database& database);

/// What the manifest says of the dataset as a whole, for the images it lists; `pending` are to come.
DatasetRecord dataset_record(const Recipe& recipe, const Plan& plan,
                             const std::vector<ImageFacts>& images,
                             const std::vector<const ImageSpec*>& pending = {});

}  // namespace ds
