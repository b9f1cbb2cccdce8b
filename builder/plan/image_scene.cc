// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/image_scene.h"

#include "tracer/base/canonical.h"

namespace ds {

void settle_image(ImageSpec& image, const Recipe& recipe, Inputs& inputs) {
  check_drawn(image, recipe);
  if (recipe.camera_fit)
    fit_image(image, recipe, inputs.model_sphere(image.model_file, recipe.normalise));
}

EnvironmentChange change_of(const ImageSpec& image) {
  const Variables& values = image.variables->values;
  return {values.environment_turn_deg, values.environment_gain};
}

std::string canonical_turn(const EnvironmentChange& change) {
  CanonicalText text;
  if (change.turn_deg != 0) text.add("environments.turn_deg", change.turn_deg);
  return text.text();
}

std::string canonical_change(const EnvironmentChange& change) {
  CanonicalText text;
  if (change.gain != 1) text.add("environments.gain", change.gain);
  return canonical_turn(change) + text.text();
}

}  // namespace ds
