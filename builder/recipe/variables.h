// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/distribution.h"
#include "builder/recipe/keys.h"

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

class Settings;

/// The numbers of a recipe that may differ from image to image, each the member that
/// variable_keys() names. Metres and degrees, as the keys.
struct Variables {
  double model_size_m = 0;
  std::array<double, 4> model_turn{1, 0, 0, 0};
  std::array<double, 3> model_place_m{};
  double distractor_count = 0;
  // Of one distractor:
  double distractor_size_m = 0;
  std::array<double, 4> distractor_turn{1, 0, 0, 0};
  std::array<double, 3> distractor_place_m{};
  double distance_m = 1;  ///< 1 with camera.distance_m = "fit"
  double elevation_deg = 0, azimuth_deg = 0, roll_deg = 0;
  double span = 0;  ///< camera.fov_deg or camera.extent_m
  double lens_radius_m = 0, focus_distance_m = 0;
  std::array<double, 3> target{}, position_m{};
  double environment_turn_deg = 0, environment_gain = 1;
  double environment_temperature_k = 0;                            ///< 0: false
  double exposure_ev = 0, vignetting = 0, blur_px = 0, noise = 0;  ///< outputs.camera
  double jpeg_quality = 0;                                         ///< 0: none

  bool operator==(const Variables&) const = default;
};

/// One key that takes a distribution. A new one is a row of variable_keys() and a member.
struct VariableKey {
  std::string_view key;
  DrawnKind kind;
  /// The first of its width_of(kind) numbers.
  double* (*at)(Variables&);
  DrawnPer per = DrawnPer::view;  ///< where the recipe does not say
};
std::span<const VariableKey> variable_keys();
/// nullptr for a key that takes none.
const VariableKey* find_variable(std::string_view key);

/// What a recipe draws for each image.
struct Drawn {
  std::string key;   ///< "camera.fov_deg"
  std::string text;  ///< the distribution as TOML, in one spelling
  Distribution distribution;
  double* (*at)(Variables&) = nullptr;  ///< null for what is no member: properties of materials
};

/// Of each Drawn of a recipe its value, one behind the other.
using DrawnValues = std::vector<DrawnValue>;

/// What the recipe gives as constants; what it draws stands as it is by default.
Variables constants_of(const Settings& settings);
/// The distributions of the recipe's keys that have an effect, in the order of the reference.
std::vector<Drawn> drawn_of(const Settings& settings);

/// Puts the values of an image in place.
void draw_all(const std::vector<Drawn>& drawn, const DrawnFor& of, Variables& variables,
              DrawnValues& values);

}  // namespace ds
