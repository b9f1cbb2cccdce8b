// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/plan.h"
#include "builder/recipe/recipe.h"
#include "manifests/concerns.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace ds {

/// "2 of 8 images show nothing of their model: a.off/0, a.off/1".
std::string to_text(const Concern& concern);

/// A count by name, of every kind.
nlohmann::json to_json(const std::vector<Concern>& concerns);

/// Tells those that there are: as warnings, or as errors where they are to be (`strict`); what the
/// recipe itself allows (classes.missing, classes.unlisted) as plain lines; and what cannot be told
/// without masks. Returns how many were told as errors.
std::size_t tell_concerns(const std::vector<Concern>& concerns, const Recipe& recipe, bool strict);

/// Warns of what a plan knows already: models and class files that do not fit each other, names that
/// are one on some disks, classes and splits that no image will be of. Returns them all.
std::vector<Concern> tell_planned_concerns(const Recipe& recipe, const Plan& plan);

/// Tells where chance dealt materials or environments out unevenly, and returns that: for "uneven" of --json.
nlohmann::json tell_uneven(const Recipe& recipe, const Plan& plan);

}  // namespace ds
