// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/diff/datasets.h"
#include "manifests/diff/pixels.h"

#include <filesystem>
#include <optional>
#include <string>

namespace ds {

/// What comparing two files found.
struct FileComparison {
  std::optional<PixelDifference> pixels;
  std::string why_not;  ///< why there are none: another size; "" where there are
};

/// Two image files. With `picture`, |a - b| is put there as PNG bytes where both can be compared.
/// Throws Error(asset, io) where one cannot be read.
FileComparison compare_files(const std::filesystem::path& a, const std::filesystem::path& b,
                             std::vector<std::byte>* picture);

/// The same of a file of two datasets; an Error(asset) where one is not what its manifest says.
FileComparison compare_files(const std::filesystem::path& folder_a,
                             const std::filesystem::path& folder_b, const ChangedFile& file,
                             std::vector<std::byte>* picture);

}  // namespace ds
