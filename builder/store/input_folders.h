// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/recipe.h"

#include <filesystem>
#include <string_view>

namespace ds {

/// Throws Error(usage) where a folder that builds write and remove files in is one that the recipe
/// reads from: its own, that of models, materials, class files, an environment, or the one these
/// stand in; or where one of those lies in what builds own of it (`images`, `manifest`, `.dsbuild`).
/// `option` names what gives the folder.
void check_no_input_folder(const std::filesystem::path& folder, std::string_view option,
                           const Recipe& recipe);

/// Throws Error(usage) where the file is one that the recipe is or reads.
void check_no_input_file(const std::filesystem::path& file, std::string_view option,
                         const Recipe& recipe);

}  // namespace ds
