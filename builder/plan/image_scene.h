// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/inputs.h"
#include "builder/recipe/recipe.h"
#include "tracer/scene/vary.h"

#include <string>

namespace ds {

/// Gives an image the place of its model and the camera it is made with: where one that was drawn sees
/// nothing it throws Error(recipe), and where the recipe wants it the model just fits. Throws what
/// reading the model throws.
void settle_image(ImageSpec& image, const Recipe& recipe, Inputs& inputs);

/// What of its environment is the image's own.
EnvironmentChange change_of(const ImageSpec& image);
/// Canonical text of what moves geometry and of what moves light; "" where nothing changes.
std::string canonical_turn(const EnvironmentChange& change);
std::string canonical_change(const EnvironmentChange& change);

}  // namespace ds
