// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/lights.h"

#include "builder/recipe/recipe.h"
#include "builder/recipe/settings.h"
#include "tracer/base/nearest.h"
#include "tracer/scene/colour_temperature.h"
#include "tracer/scene/told_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace ds {
namespace {

constexpr std::string_view k_lights = "lights";
constexpr NumberRange k_light_count{.least = 0, .most = k_most_lights};

DrawnKind kind_of(LightUse use) {
  if (use == LightUse::colour) return DrawnKind::colour;
  return use == LightUse::point || use == LightUse::source ? DrawnKind::point : DrawnKind::number;
}

/// The greatest number that a count may be.
double most_of(const Distribution& count) {
  if (count.candidates.empty()) return count.numbers.back();
  double most = 0;
  for (const Distribution& candidate : count.candidates)
    most = std::max(most, most_of(candidate));
  return most;
}

/// A constant's numbers; nothing where the value is none that the key takes.
std::optional<DrawnValue> constant_of(const LightKey& key, const RecipeValue& value) {
  const auto fits = [&](const RecipeValue& one) {
    return one.is_number() && key.range.contains(one.number());
  };
  DrawnValue numbers{};
  if (key.use == LightUse::flag && value.boolean() != nullptr) {
    numbers[0] = *value.boolean() ? 1 : 0;
    return numbers;
  }
  if (key.use == LightUse::temperature && value.boolean() != nullptr && !*value.boolean())
    return numbers;
  if (kind_of(key.use) == DrawnKind::number) {
    if (key.use == LightUse::flag || !fits(value)) return std::nullopt;
    numbers[0] = value.number();
    return numbers;
  }
  const RecipeValue::Array* list = value.array();
  if (list == nullptr || list->size() != 3 || !std::all_of(list->begin(), list->end(), fits))
    return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i)
    numbers[i] = (*list)[i].number();
  const bool is_nowhere = numbers == DrawnValue{} && key.use == LightUse::source;
  return is_nowhere ? std::nullopt : std::optional(numbers);
}

bool is_entry_name(std::string_view text) {
  return !text.empty() && text.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyz"
                              "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == text.npos;
}

/// Reads one entry of the list.
class EntryReader {
 public:
  EntryReader(const Settings& settings, Recipe& recipe, const RecipeValue& entry,
              std::size_t number)
      : settings_(settings),
        recipe_(recipe),
        entry_(entry),
        called_(fmt::format("{}[{}]", k_lights, number)) {
    light_.name = fmt::format("{}", number);
  }

  void read();

 private:
  const RecipeValue* find(std::string_view name) const {
    const auto at = entry_.table()->find(name);
    return at == entry_.table()->end() ? nullptr : &at->second;
  }
  template <typename... Args>
  void complain(const RecipeValue& at, std::string_view name, fmt::format_string<Args...> text,
                Args&&... args) const {
    settings_.complain(at, name.empty() ? called_ : fmt::format("{}.{}", called_, name),
                       fmt::format(text, std::forward<Args>(args)...));
  }
  void read_name();
  bool read_type();
  void read_count();
  void read_key(const LightKey& key);
  std::optional<Distribution> read_drawn(std::string_view name, const RecipeValue& value,
                                         DrawnKind kind, const NumberRange& range) const;
  /// Puts a distribution where those of the recipe stand; its index.
  std::size_t add_drawn(std::string key, const RecipeValue& value, Distribution distribution);

  const Settings& settings_;
  Recipe& recipe_;
  const RecipeValue& entry_;
  std::string called_;  ///< "lights[0]", in messages
  RecipeLight light_;
};

std::size_t EntryReader::add_drawn(std::string key, const RecipeValue& value,
                                   Distribution distribution) {
  const bool whole = distribution.kind == DrawnKind::integer;
  recipe_.drawn.push_back({std::move(key), to_toml(whole ? value : with_numbers(value)),
                           std::move(distribution), nullptr});
  return recipe_.drawn.size() - 1;
}

std::optional<Distribution> EntryReader::read_drawn(std::string_view name, const RecipeValue& value,
                                                    DrawnKind kind,
                                                    const NumberRange& range) const {
  return read_distribution(value, kind, range,
                           [&](const RecipeValue& at, const std::string& message) {
                             complain(at, name, "{}", message);
                           });
}

void EntryReader::read_name() {
  const RecipeValue* name = find("name");
  if (name == nullptr) return;
  const std::string* text = name->text();
  if (text == nullptr || !is_entry_name(*text))
    return complain(*name, "name", "must be a string of letters, digits and _ -, got {}",
                    to_toml(*name));
  light_.name = *text;
}

bool EntryReader::read_type() {
  std::vector<std::string_view> types;
  for (const SdlTypeRow* row : told_light_types())
    types.push_back(row->name);
  const RecipeValue* type = find("type");
  if (type == nullptr) {
    complain(entry_, "type", "must be given: one of {}", fmt::join(types, ", "));
    return false;
  }
  const std::string* text = type->text();
  if (text == nullptr || std::find(types.begin(), types.end(), *text) == types.end()) {
    complain(*type, "type", "must be one of {}, got {}{}", fmt::join(types, ", "), to_toml(*type),
             text == nullptr ? "" : did_you_mean(*text, types));
    return false;
  }
  light_.type = *text;
  return true;
}

void EntryReader::read_count() {
  const RecipeValue* count = find("count");
  if (count == nullptr) return;
  if (is_distribution(*count)) {
    auto drawn = read_drawn("count", *count, DrawnKind::integer, k_light_count);
    if (!drawn) return;
    light_.most = static_cast<int>(most_of(*drawn));
    light_.drawn_count =
        add_drawn(light_name(light_.name, 0) + ".count", *count, *std::move(drawn));
  } else if (count->integer() == nullptr || !k_light_count.contains(count->number())) {
    complain(*count, "count", "must be an integer {} or a distribution, got {}",
             k_light_count.text(), to_toml(*count));
  } else {
    light_.most = static_cast<int>(*count->integer());
  }
}

void EntryReader::read_key(const LightKey& key) {
  LightSetting setting{key, {}, {}};
  const RecipeValue* value = find(key.name);
  if (value == nullptr) {
    // Points are the model's place and more: theirs is told even where it is the default.
    if (key.default_value.empty())
      complain(entry_, key.name, "must be given: {}", wanted_text(key));
    else if (key.use == LightUse::point)
      light_.settings.push_back(std::move(setting));
    return;
  }
  if (is_distribution(*value) && key.use != LightUse::flag) {
    const auto drawn = read_drawn(key.name, *value, kind_of(key.use), key.range);
    if (!drawn) return;
    for (int number = 0; number < light_.most; ++number)
      setting.drawn.push_back(add_drawn(
          fmt::format("{}.{}", light_name(light_.name, number), key.name), *value, *drawn));
  } else if (const auto constant = constant_of(key, *value)) {
    setting.constant = *constant;
  } else {
    complain(*value, key.name, "must be {}, got {}", wanted_text(key), to_toml(*value));
  }
  light_.settings.push_back(std::move(setting));
}

void EntryReader::read() {
  read_name();
  if (!read_type()) return;
  read_count();
  const std::vector<LightKey> keys = light_keys(light_.type);
  std::vector<std::string_view> known{"name", "type", "count"};
  for (const LightKey& key : keys)
    known.push_back(key.name);
  for (const auto& [name, value] : *entry_.table())
    if (std::find(known.begin(), known.end(), name) == known.end())
      complain(value, name, "is no key of a {} light{}", light_.type, known_words(name, known));
  for (const LightKey& key : keys)
    read_key(key);
  for (const RecipeLight& other : recipe_.lights)
    if (other.name == light_.name)
      complain(entry_, "name", "must be another one than that of a light before it, got {:?}",
               light_.name);
  recipe_.lights.push_back(std::move(light_));
}

/// Adds what a setting says in the words of a scene file.
void tell(ToldLight& told, const LightSetting& setting, const DrawnValue& value, Vec3d place,
          Vec3d& gain) {
  const Vec3d three{value[0], value[1], value[2]};
  const auto add = [&](Vec3d v) {
    told.values.emplace_back(setting.key.property, std::vector<double>{v.x, v.y, v.z});
  };
  switch (setting.key.use) {
    case LightUse::number:
    case LightUse::flag:
      told.values.emplace_back(setting.key.property, std::vector<double>{value[0]});
      break;
    case LightUse::colour:
      add(three);
      break;
    case LightUse::point:
      add(place + three);
      break;
    case LightUse::source:
      // A scene file has the way light goes, or for the sun where that stands.
      add(setting.key.property == "direction" ? Vec3d{} - three : three);
      break;
    case LightUse::gain:
      gain = gain * value[0];
      break;
    case LightUse::temperature:
      if (value[0] != 0) gain = gain * black_body_colour(value[0]);
      break;
  }
}

}  // namespace

void read_recipe_lights(const Settings& settings, Recipe& recipe) {
  const RecipeValue::Array& list = *settings.find(k_lights)->array();
  for (std::size_t i = 0; i < list.size(); ++i)
    EntryReader(settings, recipe, list[i], i).read();
}

std::string light_name(const std::string& entry, int number) {
  return number == 0 ? fmt::format("{}[{}]", k_lights, entry)
                     : fmt::format("{}[{}][{}]", k_lights, entry, number);
}

std::vector<Light> lights_of(const ImageSpec& image, const Recipe& recipe) {
  std::vector<Light> lights;
  const ImageVariables& drawn = *image.variables;
  const auto& [x, y, z] = drawn.values.model_place_m;
  for (const RecipeLight& entry : recipe.lights) {
    const int count =
        entry.drawn_count ? static_cast<int>(drawn.draws[*entry.drawn_count][0]) : entry.most;
    for (int number = 0; number < count; ++number) {
      ToldLight told{light_name(entry.name, number), entry.type, {}};
      Vec3d gain{1, 1, 1};
      for (const LightSetting& setting : entry.settings)
        tell(told, setting,
             setting.drawn.empty() ? setting.constant
                                   : drawn.draws[setting.drawn[static_cast<std::size_t>(number)]],
             {x, y, z}, gain);
      told.values.emplace_back("gain", std::vector<double>{gain.x, gain.y, gain.z});
      try {
        lights.push_back(make_told_light(told));
      } catch (const Error& error) {
        fail(ErrorKind::recipe, "{}: {}", image.id, error.what());
      }
    }
  }
  return lights;
}

std::string canonical_light_list(const RecipeValue& list) {
  RecipeValue canonical = with_numbers(list);
  for (std::size_t i = 0; i < list.array()->size(); ++i) {
    const RecipeValue::Table& given = *(*list.array())[i].table();
    RecipeValue::Table& table = *std::get<RecipeValue::Array>(canonical.value)[i].table();
    if (const auto count = given.find("count"); count != given.end())
      table.find("count")->second = count->second;
  }
  return to_toml(canonical);
}

}  // namespace ds
