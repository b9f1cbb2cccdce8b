// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/environment_vary.h"

#include "builder/recipe/vary_patterns.h"
#include "tracer/base/canonical.h"
#include "tracer/base/name_pattern.h"
#include "tracer/base/nearest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace ds {
namespace {

constexpr std::string_view k_vary = "environments.vary";

bool is_of(const VaryPattern& vary, const std::string& environment) {
  return fits_pattern(environment, vary.environment);
}

/// Whether it is of what shines: a light or a material's emission.
bool is_of_light(const NodeValue& value) {
  return value.property.starts_with("lights.") ||
         (value.property.starts_with("materials.") &&
          value.property.find(".emission") != std::string::npos);
}

struct DrawnProperty {
  const NodeProperty* property;
  Vec3d value;
};

/// Puts it in the place of one of the same property, or where it belongs by its name.
void put(std::vector<DrawnProperty>& drawn, const DrawnProperty& one) {
  const auto at = std::lower_bound(drawn.begin(), drawn.end(), one,
                                   [](const DrawnProperty& a, const DrawnProperty& b) {
                                     return a.property->full_name < b.property->full_name;
                                   });
  if (at != drawn.end() && at->property->full_name == one.property->full_name)
    *at = one;
  else
    drawn.insert(at, one);
}

/// Reads a pattern for the environments of a recipe.
class PatternChecker {
 public:
  PatternChecker(const VaryPattern& vary, Diagnostics& diagnostics)
      : vary_(vary), diagnostics_(diagnostics) {}

  void check(const Recipe& recipe, Inputs& inputs);

 private:
  template <typename... Args>
  void complain(const RecipeValue& at, fmt::format_string<Args...> text, Args&&... args) {
    wrong_ = true;
    diagnostics_.add(at.place, "{} {:?} {}", k_vary, vary_.pattern + (vary_.optional ? "?" : ""),
                     fmt::format(text, std::forward<Args>(args)...));
  }
  void check_property(const NodeProperty& property, const std::string& environment);
  void complain_of_none(const std::vector<NodeProperty>& properties,
                        const std::string& environment);

  const VaryPattern& vary_;
  Diagnostics& diagnostics_;
  bool wrong_ = false;  ///< it has a finding: others would say the same of other environments
};

/// "is one number of studio's lights.warm.power, and three are drawn for it".
void PatternChecker::check_property(const NodeProperty& property, const std::string& environment) {
  const std::string name = fmt::format("{}'s {}", environment, property.full_name);
  if (property.width == 0)
    return complain(vary_.value, "names {}, which is no number to be drawn", name);
  const DrawnKind drawn = kind_of_vary(vary_.value);
  DrawnKind kind = DrawnKind::number;
  if (property.width == 3 && drawn != DrawnKind::number)
    kind = property.colour ? DrawnKind::colour : DrawnKind::point;
  if (property.width == 1 && drawn != DrawnKind::number)
    return complain(vary_.value, "is one number in {}, and three are drawn for it", name);
  if (property.width == 3 && !property.colour && drawn == DrawnKind::number)
    return complain(vary_.value, "is a point or direction in {}, and one number is drawn for it",
                    name);
  read_distribution(as_distribution(vary_.value), kind, property.range,
                    [&](const RecipeValue& at, const std::string& message) {
                      complain(at, "({}) {}", name, message);
                    });
}

void PatternChecker::complain_of_none(const std::vector<NodeProperty>& properties,
                                      const std::string& environment) {
  std::vector<std::string> names;
  for (const NodeProperty& property : properties)
    if (property.width > 0) names.push_back(property.node + "." + property.name);
  const std::vector<std::string_view> known(names.begin(), names.end());
  complain(
      vary_.value,
      "must name a property of a light, material or texture of each environment, found none "
      "in {}{}{}",
      environment, did_you_mean(vary_.node + "." + vary_.property, known),
      vary_.environment == "*" ? "; with a ? behind it such an environment is left as it is" : "");
}

void PatternChecker::check(const Recipe& recipe, Inputs& inputs) {
  std::vector<std::string> names;
  bool any_environment = false, any_property = false;
  for (const std::filesystem::path& folder : recipe.environments) {
    const std::string& name = names.emplace_back(environment_name(folder));
    if (!is_of(vary_, name)) continue;
    any_environment = true;
    bool found = false;
    try {
      for (const NodeProperty* property :
           inputs.environment_fits(folder, vary_.node, vary_.property)) {
        found = true;
        if (!wrong_) check_property(*property, name);
      }
      if (!found && !vary_.optional && !wrong_)
        complain_of_none(inputs.environment_properties(folder), name);
    } catch (const DamagedDatabase&) {
      throw;
    } catch (const Error&) {  // a folder that cannot be read fails its own images
      found = true;
    }
    any_property = any_property || found;
  }
  const std::vector<std::string_view> known(names.begin(), names.end());
  if (!any_environment)
    complain(vary_.value, "names no environment of the recipe{}",
             known_words(vary_.environment, known));
  else if (!any_property && vary_.optional)
    complain(vary_.value, "names no property of any environment");
}

}  // namespace

std::vector<NodeValue> environment_values(const ImageSpec& image, const Recipe& recipe,
                                          Inputs& inputs) {
  std::vector<DrawnProperty> drawn;
  for (const VaryPattern& vary : recipe.environment_vary) {
    if (!is_of(vary, *image.environment_name)) continue;
    const Vec3d value = vary_value(vary, recipe.drawn, image.variables->draws);
    for (const NodeProperty* property :
         inputs.environment_fits(image.environment_folder, vary.node, vary.property))
      put(drawn, {property, value});
  }
  std::vector<NodeValue> values;
  for (const auto& [property, value] : drawn)
    if (property->value != value) values.push_back({property->full_name, value, property->width});
  return values;
}

std::string canonical_values(std::span<const NodeValue> values, ValuesOf of) {
  CanonicalText text;
  for (const NodeValue& one : values) {
    if (of == ValuesOf::colours && is_of_light(one)) continue;
    const std::array<double, 3> numbers = {one.value.x, one.value.y, one.value.z};
    text.add(fmt::format("{}.{}", k_vary, one.property),
             std::span(numbers).first(static_cast<std::size_t>(one.width)));
  }
  return text.text();
}

std::string program_share_of(std::span<const NodeValue> values) {
  std::string text;
  for (const NodeValue& one : values)
    text += fmt::format("{}{}{}", text.empty() ? "" : " ", one.property,
                        one.value == Vec3d{} ? " 0" : "");
  return text;
}

void check_environment_vary(const Recipe& recipe, Inputs& inputs) {
  Diagnostics diagnostics(ErrorKind::recipe);
  for (const VaryPattern& vary : recipe.environment_vary)
    PatternChecker(vary, diagnostics).check(recipe, inputs);
  diagnostics.throw_if_any();
}

}  // namespace ds
