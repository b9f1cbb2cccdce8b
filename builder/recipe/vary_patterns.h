// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/recipe.h"

namespace ds {

class Settings;

/// Reads materials.vary into recipe.vary and, behind what is there, recipe.drawn. Findings: a pattern that is
/// none, one whose property or value is of the wrong kind or range. Whether a material has such a
/// property is told where materials are read (check_vary).
void read_vary(const Settings& settings, Recipe& recipe);

}  // namespace ds
