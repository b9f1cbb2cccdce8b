// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/recipe.h"
#include "builder/recipe/settings.h"

#include <string>
#include <utility>
#include <vector>

namespace ds {

/// Recipe::settings: key -> TOML. Paths become names, numbers get one spelling, keys without a
/// value or an effect are left out.
std::vector<std::pair<std::string, std::string>> canonical_settings(const Settings& settings,
                                                                    const Recipe& recipe);

}  // namespace ds
