// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace ds {

/// The chunks of a PNG file that its pixels are made of: the critical ones and tRNS. Of others, as a
/// colour profile that it dislikes, libpng writes lines to standard error, past everything that tells
/// files apart. Throws Error(asset) where the file is cut off.
std::vector<std::byte> pixel_chunks(std::span<const std::byte> png, const std::string& name);

}  // namespace ds
