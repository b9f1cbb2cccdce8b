// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/plan.h"
#include "tracer/device/effects.h"

#include <nlohmann/json.hpp>

#include <vector>

namespace ds {

/// What an image's program simulates and what it leaves out, and which files the image has. Needs
/// no device; reads no model.
std::vector<Effect> image_effects(const Recipe& recipe, Inputs& inputs, const ImageSpec& image);

nlohmann::json to_json(const std::vector<Effect>& effects);
/// A table, what is simulated first.
void print_effects(const std::vector<Effect>& effects);

}  // namespace ds
