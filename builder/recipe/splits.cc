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
    case SplitBy::model_class:
      return "class";
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
    case SplitBy::model_class:
      for (const ModelFile& model : recipe.models)
        names.insert(recipe.labels.find(model.name).value_or(ModelLabel{}).class_path);
      names.erase("");
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

/// What a list of things that are held out may name: of classes, those above them too.
std::set<std::string> nameable(const Recipe& recipe) {
  return recipe.split.by == SplitBy::model_class
             ? std::set<std::string>(recipe.class_paths.begin(), recipe.class_paths.end())
             : things_of(recipe);
}

std::string plural_of(SplitBy by) {
  return by == SplitBy::model_class ? "classes" : fmt::format("{}s", name_of(by));
}

bool is_named(const std::set<std::string>& names, const std::string& thing, SplitBy by) {
  if (names.contains(thing)) return true;
  if (by != SplitBy::model_class) return false;
  for (std::size_t at = thing.find('/'); at != thing.npos; at = thing.find('/', at + 1))
    if (names.contains(thing.substr(0, at))) return true;
  return false;
}

std::set<std::string> read_held_out(Settings& settings, const Recipe& recipe,
                                    std::string_view key) {
  std::set<std::string> held_out;
  const RecipeValue* list = settings.find(key);
  if (list == nullptr || list->array() == nullptr) return held_out;
  for (const char* share : {"classes.split.test", "classes.split.val"})
    if (settings.find(share) != nullptr &&
        (key == "classes.split.held_out_val" || share == std::string_view("classes.split.test")))
      settings.complain(*list, key, fmt::format("must not be given together with {}", share));
  if (list->array()->empty())
    settings.complain(*list, key, "must name something, got an empty list");
  const std::set<std::string> known = nameable(recipe);
  const std::vector<std::string_view> names(known.begin(), known.end());
  for (const RecipeValue& name : *list->array()) {
    if (!known.contains(*name.text()) && !known.empty())
      settings.complain(
          name, key,
          fmt::format("must name one of the recipe's {}, got {:?}{}", plural_of(recipe.split.by),
                      *name.text(), did_you_mean(*name.text(), names)));
    held_out.insert(*name.text());
  }
  return held_out;
}

/// Keys that do nothing without others.
void check_companions(Settings& settings, const Recipe& recipe) {
  const auto given = [&](std::initializer_list<const char*> keys) {
    return std::any_of(keys.begin(), keys.end(), [&](const char* key) {
      return settings.given(key) || settings.misspelt(key);
    });
  };
  const bool by_share = given({"classes.split.test", "classes.split.val"});
  const bool by_name = given({"classes.split.held_out", "classes.split.held_out_val"});
  if (given({"classes.split.by"}) && !by_share && !by_name && !given({"classes.split.folds"}))
    settings.complain("classes.split.by",
                      "has no effect without test, val, held_out or folds of classes.split");
  const bool without_classes = recipe.labels.size() == 0 && settings.diagnostics().empty();
  if (recipe.split.by == SplitBy::model_class && without_classes)
    settings.complain("classes.split.by", "= \"class\" wants classes: classes.from names them");
  if (!recipe.split.stratified) return;
  if (!by_share && !given({"classes.split.folds"}))
    settings.complain("classes.split.stratified",
                      "has no effect without test, val or folds of classes.split");
  else if (without_classes)
    settings.complain("classes.split.stratified", "= true wants classes: classes.from names them");
}

/// One thing is of one split.
void check_overlap(Settings& settings, const Recipe& recipe) {
  const SplitSettings& split = recipe.split;
  for (const std::string& thing : things_of(recipe))
    if (is_named(split.held_out, thing, split.by) && is_named(split.held_out_val, thing, split.by))
      settings.complain("classes.split.held_out_val",
                        fmt::format("must not name what held_out does, got {:?}", thing));
}

/// Beside class files that say what is train and test, val can take of what is train.
void check_beside_files(Settings& settings, const Recipe& recipe) {
  const bool has_files =
      settings.find("classes.train") != nullptr || settings.find("classes.test") != nullptr;
  if (!has_files && !recipe.labels.has_splits()) return;
  for (const char* key : {"classes.split.test", "classes.split.train", "classes.split.held_out",
                          "classes.split.held_out_val"})
    if (const RecipeValue* given = settings.find(key))
      settings.complain(*given, key,
                        has_files
                            ? "must not be given together with classes.train or classes.test"
                            : "must not be given where classes.from says what is train and test");
  if (recipe.split.val && recipe.split.by != SplitBy::model)
    settings.complain(
        "classes.split.val",
        fmt::format("wants classes.split.by = \"model\" where {} what is train and test, got {:?}",
                    has_files ? "class files say" : "classes.from says", name_of(recipe.split.by)));
}

/// Shares are of one whole.
void check_shares(Settings& settings, const Recipe& recipe) {
  constexpr std::string_view k_train = "classes.split.train", k_val = "classes.split.val";
  constexpr double k_rounding = 1e-9;  // 0.7 + 0.15 + 0.15 is not 1 in binary
  const double taken = recipe.split.test.value_or(0) + recipe.split.val.value_or(0);
  if (taken > 1 + k_rounding)
    settings.complain(
        k_val, fmt::format("and classes.split.test must be 1 at most together, got {:.6g}", taken));
  if (settings.find(k_train) == nullptr) return;
  const double train = settings.number(k_train);
  if (!recipe.split.test && !recipe.split.val)
    settings.complain(k_train, "has no effect without classes.split.test or classes.split.val");
  else if (taken <= 1 + k_rounding && std::abs(train + taken - 1) > k_rounding)
    settings.complain(k_train,
                      fmt::format("must be what classes.split.test and val leave, {:.6g}, got {}",
                                  1 - taken, train));
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
  for (const SplitBy each : {SplitBy::model, SplitBy::model_class, SplitBy::material,
                             SplitBy::environment, SplitBy::view})
    if (name_of(each) == by) split.by = each;
  const auto share_of = [&](std::string_view key) {
    return settings.find(key) == nullptr ? std::nullopt : std::optional(settings.number(key));
  };
  split.test = share_of("classes.split.test");
  split.val = share_of("classes.split.val");
  if (settings.find("classes.split.folds") != nullptr)
    split.folds = settings.integer("classes.split.folds");
  split.stratified = settings.boolean("classes.split.stratified");
  split.held_out = read_held_out(settings, recipe, "classes.split.held_out");
  split.held_out_val = read_held_out(settings, recipe, "classes.split.held_out_val");
  check_overlap(settings, recipe);
  check_beside_files(settings, recipe);
  check_shares(settings, recipe);
  check_companions(settings, recipe);
}

/// In [0, 1).
double Splits::place(const std::string& thing) const {
  return unit_interval(
      recipe_.split.by == SplitBy::model
          ? seeded_hash(recipe_.seed, k_for_split, {thing})
          : seeded_hash(recipe_.seed, k_for_split, {name_of(recipe_.split.by), thing}));
}

/// Of test and val; train has the rest.
struct Splits::Shares {
  double test = 0, val = 0;

  bool leave_train() const { return test + val < 1 - 1e-9; }
};

/// The first `test` things in the order of their hashes are test, and so many behind them val.
void Splits::enter(const Places& group, const Shares& shares, Take take) {
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [thing, at] : group)
    order.emplace_back(at, thing);
  std::sort(order.begin(), order.end());
  const auto size = static_cast<std::int64_t>(order.size());
  const auto below = [&](double share) {
    if (take == Take::by_share)
      return std::int64_t{std::llround(share * static_cast<double>(size))};
    return std::int64_t{std::count_if(order.begin(), order.end(),
                                      [&](const auto& entry) { return entry.first < share; })};
  };
  std::int64_t test = below(shares.test), both = below(shares.test + shares.val);
  if (take != Take::by_hash && size > 1) {
    const std::int64_t train = shares.leave_train() ? 1 : 0;
    const std::int64_t wanted = (shares.test > 0 ? 1 : 0) + (shares.val > 0 ? 1 : 0) + train;
    const std::int64_t val = shares.val > 0 && size >= wanted ? 1 : 0;  // least
    test = shares.test > 0 ? std::clamp<std::int64_t>(test, 1, size - train - val) : 0;
    both = std::clamp(both, test + val, size - train);
    if (shares.val <= 0) both = test;
  }
  for (std::int64_t i = 0; i < size; ++i)
    split_of_[order[static_cast<std::size_t>(i)].second] = i < test   ? "test"
                                                           : i < both ? "val"
                                                                      : "train";
}

void Splits::deal(const std::set<std::string>& things, const Shares& shares) {
  const SplitSettings& split = recipe_.split;
  std::map<std::string, Places> groups;
  for (const std::string& thing : things) {
    std::string group;
    if (split.stratified) group = recipe_.labels.find(thing).value_or(ModelLabel{}).class_path;
    groups[group].emplace(thing, place(thing));
  }
  for (const auto& [path, group] : groups)
    enter(group, shares,
          split.stratified && !path.empty() ? Take::by_share
          : split.by == SplitBy::model      ? Take::by_hash
                                            : Take::of_each);
}

Splits::Splits(const Recipe& recipe) : recipe_(recipe) {
  const SplitSettings& split = recipe.split;
  std::set<std::string> to_train;
  if (!split.held_out.empty() || !split.held_out_val.empty()) {
    for (const std::string& thing : things_of(recipe)) {
      std::string& own = split_of_[thing];
      own = is_named(split.held_out, thing, split.by)       ? "test"
            : is_named(split.held_out_val, thing, split.by) ? "val"
                                                            : "train";
      if (own == "train") to_train.insert(thing);
    }
  } else if (recipe.labels.has_splits()) {
    for (const ModelFile& model : recipe.models)
      if (recipe.labels.find(model.name).value_or(ModelLabel{}).split == "train")
        to_train.insert(model.name);
  } else if (split.test || split.val) {
    deal(things_of(recipe), {split.test.value_or(0), split.val.value_or(0)});
  }
  if (split.val && !to_train.empty()) deal(to_train, {0, *split.val});
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
    if (label.split == "test" || label.split == "val") continue;
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
  if (keeps_models_whole(recipe_.split.by))
    label.split = of_image(label, recipe_.split.by == SplitBy::model ? model : label.class_path);
  return label;
}

std::string Splits::of_image(const ModelLabel& label, const std::string& thing) const {
  const auto at = split_of_.find(thing);
  return at == split_of_.end() ? label.split : at->second;
}

std::optional<std::uint64_t> Splits::fold(const std::string& split,
                                          const std::string& thing) const {
  if (recipe_.split.folds == 0 || thing.empty() || split == "test" || split == "val")
    return std::nullopt;
  const auto at = fold_of_.find(thing);
  return at != fold_of_.end() ? at->second : fold_by_hash(thing);
}

const std::string& split_thing(const ImageSpec& image, SplitBy by) {
  switch (by) {
    case SplitBy::model:
      return *image.model_name;
    case SplitBy::model_class:
      return *image.class_path;
    case SplitBy::material:
      return *image.material_name;
    case SplitBy::environment:
      return *image.environment_name;
    case SplitBy::view:
      return *image.view;
  }
  assertion_failed("a SplitBy", __FILE__, __LINE__);
}

}  // namespace ds
