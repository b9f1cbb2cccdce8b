// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/plan.h"
#include "manifests/concerns.h"

#include <vector>

namespace ds {

/// Concern draws_idle: keys whose distributions change nothing of any image, each with the reason. A light that is
/// never shown, or a key of pictures where none is made, are such.
Concern find_idle_draws(const Recipe& recipe, const std::vector<PlannedImage>& images,
                        Inputs& inputs);

}  // namespace ds
