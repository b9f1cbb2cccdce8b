// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/image_scene.h"

#include "builder/plan/distractors.h"
#include "builder/plan/environment_vary.h"
#include "tracer/base/canonical.h"
#include "tracer/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace ds {

void ImageSettler::place(ImageSpec& image) {
  check_drawn(image, recipe_);
  const NormaliseOptions options = normalise_of(image, recipe_);
  if (tilts(options) && options.place_on_ground)
    image.lowest = inputs_.model_lowest(image.model_file, options);
  if (recipe_.camera_fit)
    fit_image(image, recipe_, inputs_.model_sphere(image.model_file, options, image.lowest));
  place_distractors(image, recipe_, inputs_);
  if (!recipe_.lights.empty()) image.lights = lights_of(image, recipe_);
}

namespace {

/// "visible >= 0.3 in 64 tries; best 0.21".
std::string failed_text(const Recipe& recipe, const Rejection& best, int tries) {
  const KeepSettings& keep = recipe.keep;
  const std::string in_tries = fmt::format(" in {} tr{}", tries, tries == 1 ? "y" : "ies");
  if (best.condition == "inside") return "the camera outside of the model" + in_tries;
  const double wanted = best.condition == "in_frame"  ? keep.in_frame
                        : best.condition == "visible" ? keep.visible
                                                      : keep.clearance_m;
  return fmt::format("{} >= {:g}{}; best {:.3g}", best.condition, wanted, in_tries, best.value);
}

/// How far along the conditions, which are asked in this order, a draw came.
std::size_t rank_of(const std::string& condition) {
  constexpr std::array<std::string_view, 4> k_order = {"in_frame", "inside", "clearance_m",
                                                       "visible"};
  return static_cast<std::size_t>(std::find(k_order.begin(), k_order.end(), condition) -
                                  k_order.begin());
}

}  // namespace

void ImageSettler::settle(ImageSpec& image) {
  if (!recipe_.keep.any()) return place(image);
  const int tries = draws_views(recipe_) ? recipe_.keep.tries : 1;
  std::optional<Rejection> best;
  for (int attempt = 0; attempt < tries; ++attempt) {
    if (attempt > 0) draw_again(image, recipe_, attempt);
    ++counts_.draws;
    Rejection rejection;
    try {
      place(image);
      rejection = conditions_.reject(image);
    } catch (const Error& error) {
      // A camera that sees nothing is none to keep.
      if (error.kind() != ErrorKind::recipe || attempt + 1 == tries) throw;
      rejection.condition = "camera";
    }
    if (rejection.condition.empty()) return;
    ++counts_.rejected[rejection.condition];
    if (rejection.condition == "camera") continue;
    const auto order = [](const Rejection& one) {
      return std::pair(rank_of(one.condition), one.value);
    };
    if (!best || order(rejection) > order(*best)) best = rejection;
  }
  fail(ErrorKind::recipe, "{}: no view with {}", image.id, failed_text(recipe_, *best, tries));
}

CameraEffects effects_of(const ImageSpec& image) {
  const Variables& v = image.variables->values;
  return {v.exposure_ev,    v.vignetting, v.blur_px, v.noise, static_cast<int>(v.jpeg_quality),
          image.engine.seed};
}

double turn_of(const ImageSpec& image) {
  return image.variables->values.environment_turn_deg;
}

EnvironmentChange change_of(const ImageSpec& image, const Recipe& recipe, Inputs& inputs) {
  const Variables& values = image.variables->values;
  EnvironmentChange change{turn_of(image), values.environment_gain,
                           values.environment_temperature_k};
  if (!recipe.environment_vary.empty()) change.values = environment_values(image, recipe, inputs);
  return change;
}

std::string canonical_turn(double turn_deg) {
  CanonicalText text;
  if (turn_deg != 0) text.add("environments.turn_deg", turn_deg);
  return text.text();
}

std::string canonical_change(const EnvironmentChange& change) {
  CanonicalText text;
  if (change.gain != 1) text.add("environments.gain", change.gain);
  if (change.temperature_k != 0) text.add("environments.temperature_k", change.temperature_k);
  return canonical_turn(change.turn_deg) + text.text() +
         canonical_values(change.values, ValuesOf::all);
}

}  // namespace ds
