// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/variables.h"

#include "builder/recipe/settings.h"

#include <algorithm>

namespace ds {
namespace {

constexpr VariableKey k_variables[] = {
    {"models.size_m", DrawnKind::number, [](Variables& v) { return &v.model_size_m; },
     DrawnPer::model},
    {"models.turn", DrawnKind::rotation, [](Variables& v) { return v.model_turn.data(); }},
    {"models.place_m", DrawnKind::point, [](Variables& v) { return v.model_place_m.data(); }},
    {"distractors.count", DrawnKind::integer, [](Variables& v) { return &v.distractor_count; }},
    {"distractors.place_m", DrawnKind::point,
     [](Variables& v) { return v.distractor_place_m.data(); }},
    {"distractors.size_m", DrawnKind::number, [](Variables& v) { return &v.distractor_size_m; }},
    {"distractors.turn", DrawnKind::rotation,
     [](Variables& v) { return v.distractor_turn.data(); }},
    {"environments.turn_deg", DrawnKind::number,
     [](Variables& v) { return &v.environment_turn_deg; }},
    {"environments.gain", DrawnKind::number, [](Variables& v) { return &v.environment_gain; }},
    {"environments.temperature_k", DrawnKind::number,
     [](Variables& v) { return &v.environment_temperature_k; }},
    {"camera.distance_m", DrawnKind::number, [](Variables& v) { return &v.distance_m; }},
    {"camera.position_m", DrawnKind::point, [](Variables& v) { return v.position_m.data(); }},
    {"camera.elevation_deg", DrawnKind::number, [](Variables& v) { return &v.elevation_deg; }},
    {"camera.azimuth_deg", DrawnKind::number, [](Variables& v) { return &v.azimuth_deg; }},
    {"camera.target", DrawnKind::point, [](Variables& v) { return v.target.data(); }},
    {"camera.roll_deg", DrawnKind::number, [](Variables& v) { return &v.roll_deg; }},
    {"camera.fov_deg", DrawnKind::number, [](Variables& v) { return &v.span; }},
    {"camera.extent_m", DrawnKind::number, [](Variables& v) { return &v.span; }},
    {"camera.lens_radius_m", DrawnKind::number, [](Variables& v) { return &v.lens_radius_m; }},
    {"camera.focus_distance_m", DrawnKind::number,
     [](Variables& v) { return &v.focus_distance_m; }},
    {"outputs.camera.exposure_ev", DrawnKind::number, [](Variables& v) { return &v.exposure_ev; }},
    {"outputs.camera.vignetting", DrawnKind::number, [](Variables& v) { return &v.vignetting; }},
    {"outputs.camera.blur_px", DrawnKind::number, [](Variables& v) { return &v.blur_px; }},
    {"outputs.camera.noise", DrawnKind::number, [](Variables& v) { return &v.noise; }},
    {"outputs.camera.jpeg_quality", DrawnKind::integer,
     [](Variables& v) { return &v.jpeg_quality; }},
};

/// A constant's numbers; none for a literal, a distribution and what is not given.
std::vector<double> constant_of(const Settings& settings, const VariableKey& row) {
  const RecipeValue* value = settings.find(row.key);
  if (value == nullptr) return {};
  if (value->is_number()) return {value->number()};
  std::vector<double> numbers;
  if (value->array() != nullptr)
    for (const RecipeValue& element : *value->array())
      numbers.push_back(element.number());
  if (row.kind == DrawnKind::rotation) numbers = unit_quaternion(std::move(numbers));
  return numbers;
}

}  // namespace

std::span<const VariableKey> variable_keys() {
  return k_variables;
}

const VariableKey* find_variable(std::string_view key) {
  const auto at = std::find_if(std::begin(k_variables), std::end(k_variables),
                               [&](const VariableKey& row) { return row.key == key; });
  return at == std::end(k_variables) ? nullptr : &*at;
}

Variables constants_of(const Settings& settings) {
  Variables variables;
  for (const VariableKey& row : variable_keys()) {
    if (!settings.applies(*find_key(row.key))) continue;
    const std::vector<double> numbers = constant_of(settings, row);
    std::copy(numbers.begin(), numbers.end(), row.at(variables));
  }
  return variables;
}

std::vector<Drawn> drawn_of(const Settings& settings) {
  std::vector<Drawn> drawn;
  for (const KeySpec& key : recipe_keys()) {
    const Distribution* distribution = settings.distribution(key.name);
    if (distribution == nullptr || find_variable(key.name) == nullptr) continue;
    const VariableKey& row = *find_variable(key.name);
    const RecipeValue& value = *settings.find(key.name);
    drawn.push_back({std::string(key.name),
                     to_toml(row.kind == DrawnKind::integer ? value : with_numbers(value)),
                     *distribution, row.at});
  }
  return drawn;
}

void draw_all(const std::vector<Drawn>& drawn, const DrawnFor& of, Variables& variables,
              DrawnValues& values) {
  values.clear();
  values.reserve(drawn.size());
  // What several images share stays when the view of one is drawn again.
  DrawnFor shared = of;
  shared.attempt = 0;
  for (const Drawn& one : drawn) {
    const bool own = one.distribution.per == DrawnPer::view;
    const DrawnValue& value =
        values.emplace_back(draw(one.distribution, one.key, own ? of : shared));
    if (one.at != nullptr)
      std::copy_n(value.begin(), width_of(one.distribution.kind), one.at(variables));
  }
}

}  // namespace ds
