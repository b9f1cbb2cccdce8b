// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/vary_patterns.h"

#include "builder/recipe/settings.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <algorithm>

namespace ds {
namespace {

constexpr std::string_view k_key = "materials.vary";

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

/// The range that every type's property of this name keeps; shares of light are 0 to 1.
NumberRange range_of(std::string_view property) {
  const InputLimit limit = limit_of(property);
  NumberRange range = limit.range;
  range.least = std::max(range.least, limit.physical.least);
  range.most = std::min(range.most, limit.physical.most);
  return range;
}

/// A constant is what is chosen of one value.
RecipeValue as_distribution(const RecipeValue& value) {
  if (is_distribution(value)) return value;
  RecipeValue one{RecipeValue::Array{value}, value.place, value.from_set};
  RecipeValue::Table table;
  table.emplace("choice", std::move(one));
  return {std::move(table), value.place, value.from_set};
}

}  // namespace

void read_vary(const Settings& settings, Recipe& recipe) {
  const RecipeValue& patterns = *settings.find(k_key);
  for (const auto& [text, value] : *patterns.table()) {
    const auto complain = [&, &text = text](const RecipeValue& at, const std::string& message) {
      settings.complain(at, k_key, fmt::format("{:?} {}", text, message));
    };
    VaryPattern vary{text, false, recipe.drawn.size(), value.place};
    if (vary.pattern.ends_with('?')) {
      vary.optional = true;
      vary.pattern.pop_back();
    }
    const std::size_t dot = vary.pattern.rfind('.');
    if (dot == vary.pattern.npos || dot == 0 || dot + 1 == vary.pattern.size() ||
        vary.pattern.find('*', dot) != vary.pattern.npos) {
      complain(value, "must be NAME.PROPERTY, where NAME may have *, as \"*.kd\" or \"body.kd?\"");
      continue;
    }
    const DrawnKind kind = is_of_colours(value) ? DrawnKind::colour : DrawnKind::number;
    const RecipeValue drawn = as_distribution(value);
    auto distribution = read_distribution(
        drawn, kind, range_of(std::string_view(vary.pattern).substr(dot + 1)), complain);
    if (!distribution) continue;
    recipe.drawn.push_back({fmt::format("{}.{}", k_key, vary.pattern), to_toml(with_numbers(drawn)),
                            *std::move(distribution), nullptr});
    recipe.vary.push_back(std::move(vary));
  }
}

}  // namespace ds
