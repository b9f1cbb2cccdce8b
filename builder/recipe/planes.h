// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/recipe.h"
#include "builder/recipe/settings.h"

#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// What outputs.mask, depth and planes want. A name may be LuxCore's, in capitals, where its DEPTH is
/// the plane distance.
std::vector<PlaneOutput> read_planes(const Settings& settings);

/// For the end of a finding about outputs.NAME, where NAME is a plane: the element of outputs.planes that
/// is meant, in the encoding that the value names. "" for other keys, and for outputs.mask, which says all there is to say.
std::string plane_meant(std::string_view key, const RecipeValue& value);

/// Table of planes, their encodings and conventions, for recipes/README.md.
std::string plane_reference();

}  // namespace ds
