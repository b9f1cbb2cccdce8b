// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/dataset.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace ds {

struct CleanResult {
  std::uint64_t files = 0, bytes = 0;  ///< removed, or that would be
  std::vector<std::filesystem::path>
      edited;  ///< left: not what a build wrote (PlacedFiles::find_there)
};

/// Takes a dataset's files and manifest out of its folder: those that a build placed and nobody
/// changed since. The store keeps what they were made of, so that the next build traces nothing. The
/// folder still belongs to the recipe. Throws Error(io).
CleanResult clean_dataset(Dataset& dataset, Disk& disk, bool dry_run);

}  // namespace ds
