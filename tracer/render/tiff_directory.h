// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace ds {

/// Looks at the first picture's entries of a classic TIFF file (TIFF 6.0; of a BigTIFF file at none).
/// Throws Error(asset) with `name` where no bits a sample are stated, which means 1 and OpenImageIO takes
/// for 8, and where pixels lie behind the file's end, which it reads as black.
void check_tiff(std::span<const std::byte> bytes, const std::string& name);

}  // namespace ds
