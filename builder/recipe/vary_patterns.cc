// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/vary_patterns.h"

#include "builder/recipe/settings.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <algorithm>

namespace ds {
namespace {

constexpr std::string_view k_materials = "materials.vary", k_environments = "environments.vary",
                           k_distractors = "distractors.vary";

/// Whether a list of three numbers stands for it, or is among what it chooses.
bool is_of_colours(const RecipeValue& value) {
  if (value.array() != nullptr) return true;
  if (value.table() == nullptr) return false;
  for (const auto& [name, member] : *value.table()) {
    if (name == "hsv") return true;
    if ((name == "choice" || name == "cycle") && member.array() != nullptr &&
        !member.array()->empty())
      return is_of_colours(member.array()->front());
  }
  return false;
}

/// Whether it is of a word that gives points and no colours.
bool is_of_points(const RecipeValue& value) {
  const RecipeValue::Table* table = value.table();
  return table != nullptr && std::any_of(table->begin(), table->end(), [](const auto& member) {
           const DistributionWord* word = find_word(member.first);
           return word != nullptr && may_draw(*word, DrawnKind::point) &&
                  !may_draw(*word, DrawnKind::colour);
         });
}

/// Takes "office/lamp.emission.gain?" apart; false where it is no such text. Of materials all before the last dot is
/// the name, as files' names of parts have none.
bool take_apart(VaryPattern& vary, bool of_environment) {
  if (vary.pattern.ends_with('?')) {
    vary.optional = true;
    vary.pattern.pop_back();
  }
  std::string_view rest = vary.pattern;
  vary.environment = "*";
  if (const std::size_t slash = rest.find('/'); of_environment && slash != rest.npos) {
    vary.environment = rest.substr(0, slash);
    rest.remove_prefix(slash + 1);
  }
  const std::size_t dot = of_environment ? rest.find('.') : rest.rfind('.');
  if (dot == rest.npos) return false;
  vary.node = rest.substr(0, dot);
  vary.property = rest.substr(dot + 1);
  return !vary.environment.empty() && !vary.node.empty() && !vary.property.empty() &&
         vary.property.find('*') == std::string::npos;
}

void read_patterns(const Settings& settings, std::string_view key, std::vector<Drawn>& all,
                   std::vector<VaryPattern>& to) {
  const bool of_environment = key == k_environments;
  for (const auto& [text, value] : *settings.find(key)->table()) {
    const auto complain = [&, &text = text](const RecipeValue& at, const std::string& message) {
      settings.complain(at, key, fmt::format("{:?} {}", text, message));
    };
    VaryPattern vary;
    vary.pattern = text;
    vary.drawn = all.size();
    vary.value = value;
    if (!take_apart(vary, of_environment)) {
      complain(value, of_environment
                          ? "must be NAME.PROPERTY or ENVIRONMENT/NAME.PROPERTY, where "
                            "ENVIRONMENT and NAME may have *, as \"studio/warm.gain\""
                          : "must be NAME.PROPERTY, where NAME may have *, as \"*.kd\" or "
                            "\"body.kd?\"");
      continue;
    }
    const RecipeValue drawn = as_distribution(value);
    // Materials have no places.
    const DrawnKind kind =
        of_environment || !is_of_points(value) ? kind_of_vary(value) : DrawnKind::number;
    auto distribution = read_distribution(
        drawn, kind, of_environment ? NumberRange{} : kept_range(vary.property), complain);
    if (!distribution) continue;
    all.push_back({fmt::format("{}.{}", key, vary.pattern), to_toml(with_numbers(drawn)),
                   *std::move(distribution), nullptr});
    to.push_back(std::move(vary));
  }
}

}  // namespace

RecipeValue as_distribution(const RecipeValue& value) {
  if (is_distribution(value)) return value;
  RecipeValue one{RecipeValue::Array{value}, value.place, value.from_set};
  RecipeValue::Table table;
  table.emplace("choice", std::move(one));
  return {std::move(table), value.place, value.from_set};
}

Vec3d vary_value(const VaryPattern& vary, const std::vector<Drawn>& drawn,
                 const DrawnValues& values) {
  const DrawnValue& value = values[vary.drawn];
  if (drawn[vary.drawn].distribution.kind == DrawnKind::number)
    return {value[0], value[0], value[0]};
  return {value[0], value[1], value[2]};
}

DrawnKind kind_of_vary(const RecipeValue& value) {
  if (is_of_points(value)) return DrawnKind::point;
  return is_of_colours(value) ? DrawnKind::colour : DrawnKind::number;
}

void read_vary(const Settings& settings, Recipe& recipe) {
  read_patterns(settings, k_materials, recipe.drawn, recipe.vary);
}

void read_distractor_vary(const Settings& settings, Recipe& recipe) {
  DistractorSettings& distractors = recipe.distractors;
  read_patterns(settings, k_distractors, distractors.drawn, distractors.vary);
  if (recipe.assign_materials == Assign::own && !distractors.vary.empty())
    settings.complain(k_distractors, "has no effect with materials.assign = \"own\"");
}

void read_environment_vary(const Settings& settings, Recipe& recipe) {
  read_patterns(settings, k_environments, recipe.drawn, recipe.environment_vary);
}

}  // namespace ds
