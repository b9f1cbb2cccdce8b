// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace ds {

/// A recipe for a folder of models: what it must say, and every other key as a comment with its meaning
/// and default. Paths are written as they are given.
std::string commented_recipe(const std::string& name, const std::filesystem::path& models,
                             const std::filesystem::path& assets);

}  // namespace ds
