// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/inputs.h"
#include "builder/plan/plan.h"

#include <string>
#include <vector>

namespace ds {

/// Counts the models that images of any shard show in the materials of their files and that have faces without one, or
/// what of it is not shown (k_own_notes), and says of each kind what it is.
Concern find_own_notes(const std::vector<PlannedImage>& images, Inputs& inputs,
                       std::vector<std::string>& lines);

/// What the file calls them, as text that a manifest may hold.
std::vector<std::string> names_of(const OwnMaterials& own);

}  // namespace ds
