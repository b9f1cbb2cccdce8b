// SPDX-License-Identifier: Apache-2.0
// What an entry of [[lights]] may say: made from the table of lights that scene files have.
#include "builder/recipe/keys.h"
#include "builder/recipe/lights.h"
#include "tracer/base/error.h"
#include "tracer/scene/told_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace ds {
namespace {

constexpr NumberRange k_place{.least = -1e6, .most = 1e6};

bool is_direction(const SdlParameter& parameter) {
  return parameter.name == "direction" || parameter.name == "dir";
}

/// Nothing for what other keys say.
std::optional<LightKey> key_of(const SdlParameter& parameter) {
  LightKey key{parameter.name,          parameter.name, LightUse::number, parameter.range, "",
               parameter.default_value, parameter.help};
  switch (parameter.type) {
    case SdlType::number:
      return key;
    case SdlType::flag:
      key.use = LightUse::flag;
      key.default_value = parameter.default_value == "0" ? "false" : "true";
      return key;
    case SdlType::color:
      key.use = LightUse::colour;
      key.default_value = "[1, 1, 1]";
      return key;
    case SdlType::vector:
      key.range = k_place;
      if (is_direction(parameter)) {
        key.use = LightUse::source;
        key.name = "from";
        key.default_value = "";
        key.help = "Towards where its light comes from, seen from the model; of any length";
        return key;
      }
      key.use = LightUse::point;
      key.name += "_m";
      key.unit = "m";
      // In the midst of the model there is no place for a lamp.
      key.default_value = parameter.name == "position" ? "" : "[0, 0, 0]";
      if (parameter.name == "position") key.help = "Where it stands";
      key.help += ", seen from the model's place (models.place_m)";
      return key;
    default:
      return std::nullopt;  // transformation
  }
}

std::string sentence(std::string text) {
  if (text.size() > 1 && text[0] >= 'a' && text[0] <= 'z' && text[1] != '.')
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

}  // namespace

std::vector<LightKey> light_keys(std::string_view type) {
  const KeySpec& temperature = *find_key("environments.temperature_k");
  std::vector<LightKey> keys{
      {"gain", "gain", LightUse::gain, {.least = 0}, "", "1", "A factor on its light"},
      {"temperature_k", "gain", LightUse::temperature, temperature.range,
       std::string(temperature.unit), "false",
       "Its light is times the colour, of luminance 1, of a black body of this temperature"}};
  const auto& types = told_light_types();
  const auto row = std::find_if(types.begin(), types.end(),
                                [&](const SdlTypeRow* one) { return one->name == type; });
  DS_ASSERT(row != types.end());
  for (const SdlParameter& parameter : (*row)->parameters)
    if (std::optional<LightKey> key = key_of(parameter)) {
      key->help = sentence(key->help);
      keys.push_back(*std::move(key));
    }
  return keys;
}

std::string wanted_text(const LightKey& key) {
  const std::string range = key.range.text();
  const std::string numbers = range.empty() ? "" : " " + range;
  switch (key.use) {
    case LightUse::flag:
      return "true or false";
    case LightUse::temperature:
      return "a number" + numbers + " or false or a distribution";
    case LightUse::source:
      return "a list of three numbers" + numbers + ", not all 0, or a distribution";
    case LightUse::colour:
    case LightUse::point:
      return "a list of three numbers" + numbers + " or a distribution";
    case LightUse::number:
    case LightUse::gain:
      break;
  }
  return "a number" + numbers + " or a distribution";
}

std::vector<LightKeyRow> light_key_rows() {
  std::vector<LightKeyRow> rows;
  for (const SdlTypeRow* type : told_light_types())
    for (LightKey& key : light_keys(type->name)) {
      const auto known = std::find_if(rows.begin(), rows.end(), [&](const LightKeyRow& row) {
        return row.key.name == key.name && row.key.help == key.help;
      });
      if (known == rows.end())
        rows.push_back({std::move(key), type->name});
      else
        known->types += ", " + type->name;
    }
  return rows;
}

std::string light_reference() {
  std::string types;
  for (const SdlTypeRow* type : told_light_types())
    types += fmt::format("{}`\"{}\"`", types.empty() ? "" : ", ", type->name);
  std::string text = fmt::format(
      "| key | of | type and range | unit | default | what it does |\n"
      "| --- | --- | --- | --- | --- | --- |\n"
      "| `type` | all | one of {} | | none | What kind of light; `dsbuild help lights` says more "
      "of each |\n"
      "| `name` | all | a string of letters, digits and _ - | | its number, from 0 | What draws "
      "are told by: a light that has one may stand elsewhere in the list |\n"
      "| `count` | all | an integer in [0, {}] or a distribution | | `1` | How many such lights, "
      "each drawn for itself |\n",
      types, k_most_lights);
  for (const LightKeyRow& row : light_key_rows())
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", row.key.name, row.types,
                        wanted_text(row.key), row.key.unit,
                        row.key.default_value.empty() ? "none" : "`" + row.key.default_value + "`",
                        row.key.help);
  return text;
}

}  // namespace ds
