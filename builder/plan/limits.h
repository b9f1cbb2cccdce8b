// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/database.h"
#include "builder/recipe/recipe.h"

namespace ds {

/// Throws Error(asset) for a picture of whose samples more were NaN, infinite or negative than the
/// recipe's engine.rejected_limit allows, with the counts of each kind.
void check_limits(const Recipe& recipe, const ImageSpec& image, const Product& picture);

}  // namespace ds
