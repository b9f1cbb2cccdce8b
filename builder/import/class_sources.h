// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ds {

/// One classification of a folder's .cla files.
struct ClassSource {
  std::string name;                          ///< hierarchy_name of its files
  std::vector<std::filesystem::path> files;  ///< sorted
  std::filesystem::path train, test;         ///< of these, by their names; empty: none
};

/// Of all .cla files below a folder: the main one first, then by name. Files that cannot be read are in
/// it as the others are.
std::vector<ClassSource> find_class_sources(const std::filesystem::path& folder);

}  // namespace ds
