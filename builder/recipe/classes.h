// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/recipe.h"
#include "builder/recipe/settings.h"

namespace ds {

/// What a recipe's section classes says: where classes and splits come from (classes.train and .test, or
/// classes.from), and how the models found, which it may leave out, agree with them. Every problem is a
/// finding.
void read_classes(Settings& settings, Recipe& recipe);

}  // namespace ds
