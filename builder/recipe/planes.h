// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/recipe.h"
#include "builder/recipe/settings.h"

#include <string>
#include <vector>

namespace ds {

/// What outputs.mask, depth and planes want. A name may be LuxCore's, in capitals, where its DEPTH is
/// the plane distance.
std::vector<PlaneOutput> read_planes(const Settings& settings);

/// Table of planes, their encodings and conventions, for recipes/README.md.
std::string plane_reference();

}  // namespace ds
