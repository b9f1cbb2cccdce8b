// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/evenness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace ds {
namespace {

/// Of each candidate how often it was chosen.
using Choices = std::map<std::string, std::size_t>;

std::size_t sum_of(const Choices& choices) {
  std::size_t sum = 0;
  for (const auto& [name, count] : choices)
    sum += count;
  return sum;
}

/// Compares by count.
bool fewer(const Choices::value_type& a, const Choices::value_type& b) {
  return a.second < b.second;
}

struct Axis {
  const char* kind;
  Assign assign;
  ChoosePer per;
  SplitBy itself;
  Choices none;  ///< of each candidate 0
  Shared<std::string> ImageSpec::*shown;
};

template <typename Name>
Choices none_of(const std::vector<std::filesystem::path>& files, const Name& name) {
  Choices none;
  for (const auto& file : files)
    none[name(file)] = 0;
  return none;
}

void look_at_splits(const std::map<std::string, Choices>& splits, Uneven& found) {
  const std::size_t candidates = splits.begin()->second.size();
  found.even_share = 1 / static_cast<double>(candidates);
  for (const auto& [split, choices] : splits) {
    const auto [least, most] = std::minmax_element(choices.begin(), choices.end(), fewer);
    const auto all = static_cast<double>(sum_of(choices));
    const double most_share = static_cast<double>(most->second) / all,
                 least_share = static_cast<double>(least->second) / all;
    const bool is_uneven =
        most->second - least->second > 1 &&
        (most_share > 1.5 * found.even_share || least_share < found.even_share / 2);
    if (!is_uneven || most_share - least_share <= found.most_share - found.least_share) continue;
    found.split = split;
    found.most = most->first;
    found.least = least->first;
    found.most_share = most_share;
    found.least_share = least_share;
  }
}

void look_at_classes(const std::map<std::pair<std::string, std::string>, Choices>& classes,
                     Uneven& found) {
  for (const auto& [of, choices] : classes) {
    const auto& [class_path, split] = of;
    if (class_path.empty() || sum_of(choices) < choices.size()) continue;
    ++found.classes;
    if (std::min_element(choices.begin(), choices.end(), fewer)->second > 0) continue;
    found.lacking.push_back(split.empty() ? class_path : fmt::format("{} ({})", class_path, split));
  }
}

Uneven look(const Axis& axis, const Plan& plan) {
  std::map<std::string, Choices> splits;
  std::map<std::pair<std::string, std::string>, Choices> classes;
  std::set<std::pair<std::string, std::string>> chosen;  // by model and split, once
  for (const PlannedImage& image : plan.images) {
    if (image.error) continue;
    const ImageSpec& spec = image.spec;
    const std::string view = axis.per == ChoosePer::view ? *spec.view : "";
    if (!chosen.insert({*spec.model_name, view + " " + *spec.split}).second) continue;
    const std::string& name = *(spec.*axis.shown);
    ++splits.try_emplace(*spec.split, axis.none).first->second[name];
    ++classes.try_emplace({*spec.class_path, *spec.split}, axis.none).first->second[name];
  }
  Uneven found;
  found.kind = axis.kind;
  if (!splits.empty()) look_at_splits(splits, found);
  look_at_classes(classes, found);
  return found;
}

std::string percent(double share) {
  return fmt::format("{:.0f} %", 100 * share);
}

}  // namespace

std::vector<Uneven> find_uneven(const Recipe& recipe, const Plan& plan) {
  const Axis axes[] = {
      {"materials", recipe.assign_materials, recipe.materials_per, SplitBy::material,
       none_of(recipe.materials, material_name), &ImageSpec::material_name},
      {"environments", recipe.assign_environments, recipe.environments_per, SplitBy::environment,
       none_of(recipe.environments, environment_name), &ImageSpec::environment_name}};
  std::vector<Uneven> all;
  for (const Axis& axis : axes) {
    if (axis.assign != Assign::random || axis.none.size() < 2 || recipe.split.by == axis.itself)
      continue;
    Uneven found = look(axis, plan);
    if (!found.most.empty() || !found.lacking.empty()) all.push_back(std::move(found));
  }
  return all;
}

std::string to_text(const Uneven& uneven) {
  constexpr std::size_t k_shown = 3;
  std::string text = fmt::format("{} fall unevenly:", uneven.kind);
  if (!uneven.most.empty())
    text += fmt::format(" {}{} {} and {} {} ({} each would be even)",
                        uneven.split.empty() ? "" : "of " + uneven.split + " ",
                        percent(uneven.most_share), uneven.most, percent(uneven.least_share),
                        uneven.least, percent(uneven.even_share));
  if (!uneven.lacking.empty()) {
    const std::size_t shown = std::min(k_shown, uneven.lacking.size());
    text +=
        fmt::format("{} {} of {} classes never show{} one: {}", uneven.most.empty() ? "" : ";",
                    uneven.lacking.size(), uneven.classes, uneven.lacking.size() == 1 ? "s" : "",
                    fmt::join(uneven.lacking.begin(),
                              uneven.lacking.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
    if (uneven.lacking.size() > shown)
      text += fmt::format(" and {} more", uneven.lacking.size() - shown);
  }
  return text + fmt::format("; {}.assign = \"balanced\" evens them out", uneven.kind);
}

}  // namespace ds
