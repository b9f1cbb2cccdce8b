// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/cmd/arguments.h"

#include <cstdint>
#include <string>

namespace ds {

/// What the dataset lacks of its recipe.
struct BehindRecipe {
  std::string text;          ///< "" where nothing, or where nobody can tell
  std::uint64_t unmade = 0;  ///< images of the recipe that the manifest does not list
  std::uint64_t images = 0;  ///< of the recipe
};
/// For verbs that write what the manifest lists. `written`: "exported is what the manifest lists".
BehindRecipe behind_recipe(const Arguments& arguments, const std::string& written);

}  // namespace ds
