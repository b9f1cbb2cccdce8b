// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/inputs.h"
#include "builder/recipe/recipe.h"
#include "tracer/scene/vary.h"

#include <span>
#include <string>
#include <vector>

namespace ds {

/// What environments.vary drew for an image that its environment's file has otherwise, sorted by property.
/// Throws where the file cannot be read.
std::vector<NodeValue> environment_values(const ImageSpec& image, const Recipe& recipe,
                                          Inputs& inputs);

/// Canonical text of values; `colours`: of those alone that are of surfaces, not of what shines.
enum class ValuesOf { all, colours };
std::string canonical_values(std::span<const NodeValue> values, ValuesOf of);

/// What of them a scene's program depends on: which stand in place of others, and which are 0, as of a light that
/// is dark then; "" of none.
std::string program_share_of(std::span<const NodeValue> values);

/// Throws Error(recipe), all findings, where a pattern of environments.vary names no environment, or no
/// property of those that it names, or gives a property what it does not take.
void check_environment_vary(const Recipe& recipe, Inputs& inputs);

}  // namespace ds
