// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/recipe.h"

namespace ds {

class Settings;

/// Reads materials.vary into recipe.vary and, behind what is there, recipe.drawn. Findings: a pattern that is
/// none, one whose property or value is of the wrong kind or range. Whether a material has such a
/// property is told where materials are read (check_vary).
void read_vary(const Settings& settings, Recipe& recipe);
/// As read_vary, of distractors.vary, into recipe.distractors. Findings too: distractors that show materials of
/// their own.
void read_distractor_vary(const Settings& settings, Recipe& recipe);
/// As read_vary, of environments.vary; of values' kinds and ranges only what no property takes
/// (check_environment_vary).
void read_environment_vary(const Settings& settings, Recipe& recipe);

/// What was drawn for a pattern; of one number all three alike.
Vec3d vary_value(const VaryPattern& vary, const std::vector<Drawn>& drawn,
                 const DrawnValues& values);

/// What a pattern's value is read as: a colour where a list of three numbers or {hsv} stands for it, or a point.
DrawnKind kind_of_vary(const RecipeValue& value);
/// A distribution; a constant as what is chosen of one value.
RecipeValue as_distribution(const RecipeValue& value);

}  // namespace ds
