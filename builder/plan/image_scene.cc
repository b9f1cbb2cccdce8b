// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/image_scene.h"

#include "tracer/base/canonical.h"

namespace ds {

void settle_image(ImageSpec& image, const Recipe& recipe, Inputs& inputs) {
  check_drawn(image, recipe);
  const NormaliseOptions options = normalise_of(image, recipe);
  if (tilts(options) && options.place_on_ground)
    image.lowest = inputs.model_lowest(image.model_file, options);
  if (recipe.camera_fit)
    fit_image(image, recipe, inputs.model_sphere(image.model_file, options, image.lowest));
}

EnvironmentChange change_of(const ImageSpec& image) {
  const Variables& values = image.variables->values;
  return {values.environment_turn_deg, values.environment_gain, values.environment_temperature_k};
}

std::string canonical_turn(const EnvironmentChange& change) {
  CanonicalText text;
  if (change.turn_deg != 0) text.add("environments.turn_deg", change.turn_deg);
  return text.text();
}

std::string canonical_change(const EnvironmentChange& change) {
  CanonicalText text;
  if (change.gain != 1) text.add("environments.gain", change.gain);
  if (change.temperature_k != 0) text.add("environments.temperature_k", change.temperature_k);
  return canonical_turn(change) + text.text();
}

}  // namespace ds
