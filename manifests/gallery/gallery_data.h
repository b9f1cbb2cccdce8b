// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/check/check.h"
#include "manifests/gallery/made_files.h"
#include "manifests/manifest.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// Counts up when the page of an older dsbuild could not read the data files.
inline constexpr int k_gallery_format = 1;
inline constexpr std::size_t k_grid_chunk = 5000, k_image_chunk = 100;

/// What the data files say of the dataset as a whole.
struct GalleryFacts {
  DatasetRecord dataset;
  nlohmann::json conventions;  ///< as dataset.json has them
  std::string root;            ///< of the dataset, seen from the gallery: ".."
  std::vector<std::string> notes;
  std::vector<CheckFinding> findings;  ///< of `dsbuild check`, the worst first
};

/// Writes data/*.js. `lines`: of images.jsonl; `write` takes a path and its text.
void write_gallery_data(const GalleryFacts& facts, const std::vector<std::string>& lines,
                        const std::vector<ImageRecord>& images, const MadeFiles& made,
                        const std::function<void(const std::string&, std::string_view)>& write);

}  // namespace ds
