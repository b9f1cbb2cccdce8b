// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/file_names.h"

#include <algorithm>
#include <string>

namespace ds {

bool has_ending(const std::filesystem::path& file, std::string_view ending) {
  const std::string own = file.extension().string();
  return std::equal(own.begin(), own.end(), ending.begin(), ending.end(), [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  });
}

bool is_named_hdr(const std::filesystem::path& file) {
  return has_ending(file, ".exr") || has_ending(file, ".hdr") || has_ending(file, ".pfm");
}

}  // namespace ds
