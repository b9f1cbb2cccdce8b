// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/inputs.h"
#include "builder/plan/view_conditions.h"
#include "builder/recipe/recipe.h"
#include "tracer/render/camera_effects.h"
#include "tracer/scene/vary.h"

#include <cstdint>
#include <map>
#include <string>

namespace ds {

/// How many draws camera.keep rejected, by condition.
struct DrawCounts {
  std::uint64_t draws = 0;
  std::map<std::string, std::uint64_t> rejected;
};

/// Gives images the places of their models and distractors, their lights and the cameras they are made with: those that just show the
/// model where the recipe wants that, and of the draws the first that camera.keep lets pass.
class ImageSettler {
 public:
  ImageSettler(const Recipe& recipe, Inputs& inputs)
      : recipe_(recipe), inputs_(inputs), conditions_(recipe, inputs) {}

  /// Throws Error(recipe) where the camera that was drawn sees nothing, or no draw passes, and what reading
  /// the model throws.
  void settle(ImageSpec& image);
  const DrawCounts& counts() const { return counts_; }

 private:
  void place(ImageSpec& image);

  const Recipe& recipe_;
  Inputs& inputs_;
  ViewConditions conditions_;
  DrawCounts counts_;
};

/// What is done to its picture behind the film.
CameraEffects effects_of(const ImageSpec& image);

/// What of its environment is the image's own.
EnvironmentChange change_of(const ImageSpec& image, const Recipe& recipe, Inputs& inputs);
/// EnvironmentChange::turn_deg of it.
double turn_of(const ImageSpec& image);
/// Canonical text of what moves geometry and of what moves light; "" where nothing changes.
std::string canonical_turn(double turn_deg);
std::string canonical_change(const EnvironmentChange& change);

}  // namespace ds
