// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/distribution.h"
#include "builder/recipe/value.h"
#include "tracer/scene/scene.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

class Settings;
struct ImageSpec;
struct Recipe;

/// Most lights of one entry of [[lights]].
inline constexpr int k_most_lights = 15;

/// What becomes of a value that an entry of [[lights]] has.
enum class LightUse {
  number,       ///< the property of that name
  flag,         ///< likewise; takes no distribution
  colour,       ///< likewise, linear Rec.709
  point,        ///< a property that is a point: metres from the model's place
  source,       ///< a direction towards where light comes from, of any length
  gain,         ///< a factor on all its light
  temperature,  ///< of a black body, whose colour of luminance 1 is another
};

/// One key of an entry of [[lights]], beside name, type and count.
struct LightKey {
  std::string name;      ///< "position_m"
  std::string property;  ///< of the scene files' light: "position"
  LightUse use = LightUse::number;
  NumberRange range{};  ///< of each number
  std::string unit;
  std::string default_value;  ///< "" where it must be given
  std::string help;
};
/// Those that lights of a type have, of told_light_types().
std::vector<LightKey> light_keys(std::string_view type);

/// What an entry says of its lights.
struct LightSetting {
  LightKey key;
  DrawnValue constant{};
  std::vector<std::size_t> drawn;  ///< of Recipe::drawn, by the light's number; none: `constant`
};

/// An entry of [[lights]].
struct RecipeLight {
  std::string name, type;
  int most = 1;                            ///< how many, where that is not drawn
  std::optional<std::size_t> drawn_count;  ///< of Recipe::drawn
  std::vector<LightSetting> settings;
};

/// Reads [[lights]] into recipe.lights and, behind what is there, recipe.drawn.
void read_recipe_lights(const Settings& settings, Recipe& recipe);

/// "lights[key]" of the first light of an entry, "lights[key][1]" of the next.
std::string light_name(const std::string& entry, int number);

/// Those that the image shows beside its environment's, by what was drawn for it. Throws
/// Error(recipe) where that is no light, as a sun below the horizon.
std::vector<Light> lights_of(const ImageSpec& image, const Recipe& recipe);

/// As TOML in one spelling: its numbers are numbers, counts whole ones.
std::string canonical_light_list(const RecipeValue& list);

/// A row of the reference: a key, and the types of lights that have it.
struct LightKeyRow {
  LightKey key;
  std::string types;  ///< "point, spot"
};
/// Of all keys, each once for each meaning, in the types' order.
std::vector<LightKeyRow> light_key_rows();
/// "a number > 0 or a distribution": what a key's value must be.
std::string wanted_text(const LightKey& key);
/// The reference of recipes/README.md: a Markdown table.
std::string light_reference();

}  // namespace ds
