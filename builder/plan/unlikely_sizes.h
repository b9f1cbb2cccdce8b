// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/inputs.h"
#include "builder/plan/plan.h"

#include <optional>
#include <string>
#include <vector>

namespace ds {

/// The lengths of one image, in metres, in the world.
struct ImageLengths {
  Camera camera;
  int width = 1, height = 1;
  Box model;
  double environment_m = 0;  ///< longest side of the box around its objects; 0: it has none
};

/// What can be wrong with them before anything is traced. A length given in millimetres for metres
/// is one of these; a thing meant to be so large or so near is hardly ever.
enum class UnlikelySize {
  camera_inside,  ///< the camera stands inside the model's box
  model_large,    ///< the model is over 4 times as long as all that the environment holds
  view_narrow,    ///< the angle of view is below pi and shows under a quarter of the model's length
  out_of_view,    ///< the model's box is wholly outside of what the camera sees
  model_tiny,     ///< the model is smaller than two pixels
  lens_wide,      ///< the lens is wider than the camera's distance, or than a model it is near to
  out_of_focus,  ///< the plane in focus is 100 times as far as the model, or near, or blurs it away
};

/// Of the model's size and place, and of the lens: at most one of each, the first that holds.
std::optional<UnlikelySize> unlikely_place(const ImageLengths& image);
std::optional<UnlikelySize> unlikely_lens(const ImageLengths& image);

/// Counts the images of all shards whose lengths hardly go together, and says of each kind, with the
/// figures of the first image, what it is and which length may be in another unit. Nothing is traced;
/// models and environments are read where `inputs` does not know them.
Concern find_unlikely_sizes(const Recipe& recipe, const std::vector<PlannedImage>& images,
                            Inputs& inputs, std::vector<std::string>& lines);

}  // namespace ds
