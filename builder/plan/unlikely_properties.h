// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/inputs.h"
#include "builder/plan/plan.h"

#include <string>
#include <vector>

namespace ds {

/// Counts the models whose colours, uvs or normals are hardly what is meant (unlikely_properties of
/// their files) and are read by an image of any shard, and says of each kind what it is. Materials are
/// read only for models that have something of the kind. Parts of models that are never read (materials,
/// lines) are said likewise, and not counted.
Concern find_unlikely_properties(const Recipe& recipe, const std::vector<PlannedImage>& images,
                                 Inputs& inputs, std::vector<std::string>& lines);

}  // namespace ds
