// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/inputs.h"
#include "builder/plan/plan.h"
#include "manifests/concerns.h"

#include <vector>

namespace ds {

/// Models and environments of images that can be made, whose damage is said where they are read.
Concern count_damaged(const std::vector<PlannedImage>& images, Inputs& inputs);
/// Counts the files, whose findings were said when they were read.
Concern count_unphysical(const std::vector<PlannedImage>& images, Inputs& inputs);
/// Likewise, of what is hardly meant; warns of environments without any light, where the recipe gives them none either.
Concern count_unlikely_assets(const Recipe& recipe, const std::vector<PlannedImage>& images,
                              Inputs& inputs);
/// Counts the images whose files another's would replace where case does not count.
Concern count_names_by_case(const std::vector<PlannedImage>& images);
/// Images that show fewer distractors than were drawn.
Concern count_unplaced(const Recipe& recipe, const std::vector<PlannedImage>& images);

}  // namespace ds
