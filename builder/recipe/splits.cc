// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/splits.h"

#include "builder/recipe/seeded_hash.h"
#include "tracer/base/nearest.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {
namespace {

constexpr std::string_view k_for_split = "split";
constexpr std::string_view k_for_fold = "fold";

std::string_view name_of(SplitBy by) {
  switch (by) {
    case SplitBy::model:
      return "model";
    case SplitBy::material:
      return "material";
    case SplitBy::environment:
      return "environment";
    case SplitBy::view:
      return "view";
  }
  assertion_failed("a SplitBy", __FILE__, __LINE__);
}

/// The names of all that is split.
std::set<std::string> things_of(const Recipe& recipe) {
  std::set<std::string> names;
  switch (recipe.split.by) {
    case SplitBy::model:
      for (const ModelFile& model : recipe.models)
        names.insert(model.name);
      break;
    case SplitBy::material:
      for (const auto& file : recipe.materials)
        names.insert(material_name(file));
      if (recipe.assign_materials == Assign::own) names.insert(k_own_materials);
      break;
    case SplitBy::environment:
      for (const auto& folder : recipe.environments)
        names.insert(environment_name(folder));
      break;
    case SplitBy::view:
      names.insert(recipe.view_names.begin(), recipe.view_names.end());
      break;
  }
  return names;
}

void read_held_out(Settings& settings, Recipe& recipe) {
  constexpr std::string_view k_key = "classes.split.held_out";
  const RecipeValue* list = settings.find(k_key);
  if (list == nullptr || list->array() == nullptr) return;
  if (settings.find("classes.split.test") != nullptr)
    settings.complain(*list, k_key, "must not be given together with classes.split.test");
  if (list->array()->empty())
    settings.complain(*list, k_key, "must name something, got an empty list");
  const std::set<std::string> known = things_of(recipe);
  const std::vector<std::string_view> names(known.begin(), known.end());
  for (const RecipeValue& name : *list->array()) {
    if (!known.contains(*name.text()) && !known.empty())
      settings.complain(
          name, k_key,
          fmt::format("must name one of the recipe's {}s, got {:?}{}", name_of(recipe.split.by),
                      *name.text(), did_you_mean(*name.text(), names)));
    recipe.split.held_out.insert(*name.text());
  }
}

/// Keys that do nothing without others.
void check_companions(Settings& settings, const Recipe& recipe) {
  const auto given = [&](std::initializer_list<const char*> keys) {
    return std::any_of(keys.begin(), keys.end(), [&](const char* key) {
      return settings.given(key) || settings.misspelt(key);
    });
  };
  if (given({"classes.split.by"}) &&
      !given({"classes.split.test", "classes.split.held_out", "classes.split.folds"}))
    settings.complain("classes.split.by",
                      "has no effect without classes.split.test, classes.split.held_out or "
                      "classes.split.folds");
  if (!recipe.split.stratified) return;
  if (!given({"classes.split.test", "classes.split.folds"}))
    settings.complain("classes.split.stratified",
                      "has no effect without classes.split.test or classes.split.folds");
  else if (recipe.labels.size() == 0 && settings.diagnostics().empty())
    settings.complain("classes.split.stratified", "= true wants classes: classes.from names them");
}

/// Moves as few as make all folds as large, give or take one.
void even_out(std::vector<std::vector<std::pair<double, std::string>>>& folds) {
  std::size_t all = 0;
  std::vector<std::size_t> by_size(folds.size());
  for (std::size_t fold = 0; fold < folds.size(); ++fold) {
    std::sort(folds[fold].begin(), folds[fold].end());
    all += folds[fold].size();
    by_size[fold] = fold;
  }
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](std::size_t a, std::size_t b) { return folds[a].size() > folds[b].size(); });
  std::vector<std::size_t> wanted(folds.size(), all / folds.size());
  for (std::size_t i = 0; i < all % folds.size(); ++i)
    ++wanted[by_size[i]];
  std::vector<std::pair<double, std::string>> spare;
  for (std::size_t fold = 0; fold < folds.size(); ++fold)
    for (; folds[fold].size() > wanted[fold]; folds[fold].pop_back())
      spare.push_back(std::move(folds[fold].back()));
  for (std::size_t fold = 0; fold < folds.size(); ++fold)
    for (; folds[fold].size() < wanted[fold]; spare.pop_back())
      folds[fold].push_back(std::move(spare.back()));
}

}  // namespace

void read_split(Settings& settings, Recipe& recipe) {
  SplitSettings& split = recipe.split;
  const std::string& by = settings.text("classes.split.by");
  for (const SplitBy each :
       {SplitBy::model, SplitBy::material, SplitBy::environment, SplitBy::view})
    if (name_of(each) == by) split.by = each;
  if (settings.find("classes.split.test") != nullptr)
    split.test = settings.number("classes.split.test");
  if (settings.find("classes.split.folds") != nullptr)
    split.folds = settings.integer("classes.split.folds");
  split.stratified = settings.boolean("classes.split.stratified");
  read_held_out(settings, recipe);
  const bool has_files =
      settings.find("classes.train") != nullptr || settings.find("classes.test") != nullptr;
  for (const char* key : {"classes.split.test", "classes.split.held_out"}) {
    const RecipeValue* given = settings.find(key);
    if (given == nullptr) continue;
    if (has_files)
      settings.complain(*given, key,
                        "must not be given together with classes.train or classes.test");
    else if (recipe.labels.has_splits())
      settings.complain(*given, key,
                        "must not be given where classes.from says what is train and test");
  }
  check_companions(settings, recipe);
}

/// In [0, 1).
double Splits::place(const std::string& thing) const {
  return unit_interval(
      recipe_.split.by == SplitBy::model
          ? seeded_hash(recipe_.seed, k_for_split, {thing})
          : seeded_hash(recipe_.seed, k_for_split, {name_of(recipe_.split.by), thing}));
}

void Splits::enter(const std::map<std::string, double>& group, bool both) {
  const double share = *recipe_.split.test;
  for (const auto& [thing, at] : group)
    is_test_[thing] = at < share;
  if (!both || group.size() < 2 || share <= 0 || share >= 1) return;
  const auto by_place = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto [least, most] = std::minmax_element(group.begin(), group.end(), by_place);
  if (least->second >= share) is_test_[least->first] = true;
  if (most->second < share) is_test_[most->first] = false;
}

void Splits::enter_share(const std::map<std::string, double>& group) {
  const double share = *recipe_.split.test;
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [thing, at] : group)
    order.emplace_back(at, thing);
  std::sort(order.begin(), order.end());
  const auto size = static_cast<std::int64_t>(order.size());
  std::int64_t count = std::llround(share * static_cast<double>(size));
  if (size > 1 && share > 0 && share < 1) count = std::clamp<std::int64_t>(count, 1, size - 1);
  for (std::int64_t i = 0; i < size; ++i)
    is_test_[order[static_cast<std::size_t>(i)].second] = i < count;
}

Splits::Splits(const Recipe& recipe) : recipe_(recipe) {
  const SplitSettings& split = recipe.split;
  const bool by_model = split.by == SplitBy::model;
  if (!split.held_out.empty()) {
    for (const std::string& thing : things_of(recipe))
      is_test_[thing] = split.held_out.contains(thing);
  } else if (split.test) {
    std::map<std::string, std::map<std::string, double>> groups;
    for (const std::string& thing : things_of(recipe)) {
      std::string group;
      if (split.stratified) group = recipe.labels.find(thing).value_or(ModelLabel{}).class_path;
      groups[group].emplace(thing, place(thing));
    }
    for (const auto& [path, group] : groups)
      if (split.stratified && !path.empty())
        enter_share(group);
      else
        enter(group, !by_model);
  }
  if (split.stratified && split.folds > 0) enter_folds();
}

/// In [0, 1).
double Splits::fold_place(const std::string& thing) const {
  return unit_interval(seeded_hash(recipe_.seed, k_for_fold, {name_of(recipe_.split.by), thing}));
}

std::uint64_t Splits::fold_by_hash(const std::string& thing) const {
  const auto folds = static_cast<std::uint64_t>(recipe_.split.folds);
  return std::min(static_cast<std::uint64_t>(fold_place(thing) * static_cast<double>(folds)),
                  folds - 1);
}

void Splits::enter_folds() {
  std::map<std::string, std::vector<std::vector<std::pair<double, std::string>>>> classes;
  for (const ModelFile& model : recipe_.models) {
    const ModelLabel label = of_model(model.name);
    if (label.split == "test") continue;
    auto& folds = classes[label.class_path];
    folds.resize(static_cast<std::size_t>(recipe_.split.folds));
    folds[fold_by_hash(model.name)].emplace_back(fold_place(model.name), model.name);
  }
  for (auto& [path, folds] : classes) {
    even_out(folds);
    for (std::size_t fold = 0; fold < folds.size(); ++fold)
      for (const auto& [at, thing] : folds[fold])
        fold_of_[thing] = fold;
  }
}

ModelLabel Splits::of_model(const std::string& model) const {
  ModelLabel label = recipe_.labels.find(model).value_or(ModelLabel{});
  if (recipe_.split.by == SplitBy::model) label.split = of_image(label, model);
  return label;
}

std::string Splits::of_image(const ModelLabel& label, const std::string& thing) const {
  const auto at = is_test_.find(thing);
  if (at == is_test_.end()) return label.split;
  return at->second ? "test" : "train";
}

std::optional<std::uint64_t> Splits::fold(const std::string& split,
                                          const std::string& thing) const {
  if (recipe_.split.folds == 0 || split == "test") return std::nullopt;
  const auto at = fold_of_.find(thing);
  return at != fold_of_.end() ? at->second : fold_by_hash(thing);
}

}  // namespace ds
