// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/plan.h"

#include <nlohmann/json.hpp>

namespace ds {

/// What the recipe draws: a line a key with its distribution, and the least, greatest and mean value of
/// the plan's images that can be made; with `each_image` a line for each of them too.
void print_draws(const Recipe& recipe, const Plan& plan, bool each_image);
/// {"draws": {KEY: {...}}, "image_draws": {ID: {KEY: value}}}: as in the manifest.
nlohmann::json draws_json(const Recipe& recipe, const Plan& plan);
/// A line a key: what was drawn for the image.
void print_draws(const Recipe& recipe, const ImageSpec& image);

/// Prints which share of the draws camera.keep rejected, by condition; nothing where it asks nothing.
void print_rejected(const Recipe& recipe, const DrawCounts& counts);
/// {"draws": 120, "rejected": {"visible": 17}}.
nlohmann::json rejected_json(const DrawCounts& counts);

}  // namespace ds
