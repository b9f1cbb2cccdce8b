// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/diff/datasets.h"
#include "manifests/diff/pictures.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace ds {

/// What comparing each file of a changed image found; as long as its `files`, empty ones where a
/// dataset has none or both have the same picture.
using FileComparisons = std::vector<FileComparison>;

/// "24 of 1024 pixels, largest 0.23 at 7, 9, RMS 0.012"
std::string difference_text(const FileComparison& found);
nlohmann::json difference_json(const FileComparison& found);

/// In lines: images in one alone, then by what differs, worst file of each kind; with `verbose` every
/// image and file.
void print_difference(const DatasetDifference& found,
                      const std::vector<FileComparisons>& comparisons, bool verbose);
nlohmann::json difference_json(const DatasetDifference& found,
                               const std::vector<FileComparisons>& comparisons);

}  // namespace ds
