// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace ds {

/// Whether a path has that ending (".ply", in small letters), in any case.
bool has_ending(const std::filesystem::path& file, std::string_view ending);

/// Whether a name says that the file holds floats, which are linear: an image that has no gamma.
bool is_named_hdr(const std::filesystem::path& file);

}  // namespace ds
