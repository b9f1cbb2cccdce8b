// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/inputs.h"
#include "builder/recipe/recipe.h"

#include <string>
#include <string_view>

namespace ds {

/// The image's material with what materials.vary drew for it.
Scene material_of(const ImageSpec& image, const Recipe& recipe, Inputs& inputs);
/// A distractor's with what distractors.vary drew for it.
Scene material_of(const Distractor& distractor, const Recipe& recipe, Inputs& inputs);
/// What tells of the ids in the plane material_id where a model shows it: its own materials' are their numbers.
std::string ids_of_model(const Scene& material);
/// Names what a program depends on of a model's own materials, which thousands of models have in common.
Hash128 program_name_of(const Scene& material);
/// Names what any program depends on of the material of one more thing in its scene.
Hash128 program_share_of(const Scene& material);
/// Canonical text of what was drawn for it; "" where nothing is.
std::string canonical_vary(const ImageSpec& image, const Recipe& recipe);
std::string canonical_vary(const Distractor& distractor, const Recipe& recipe);
/// Throws Error(recipe), all findings, where a pattern of materials.vary or distractors.vary names no property of any material, or
/// without a "?" of one, or gives a colour to a property of one number.
void check_vary(const Recipe& recipe, Inputs& inputs);

/// The image's scene with one triangle in the place of the model and of each distractor, and none of its environment's:
/// all that its program depends on.
/// Throws where a file cannot be read.
Scene scene_without_model(const Recipe& recipe, Inputs& inputs, const ImageSpec& image);

}  // namespace ds
