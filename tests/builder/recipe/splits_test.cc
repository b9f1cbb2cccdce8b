// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/splits.h"

#include "tests/builder/recipe_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace ds {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string model_name(int number) {
  return fmt::format("m{:03}.off", number);
}

/// Classes of 1, 2, ..., `classes` models.
Recipe recipe_of(int classes) {
  Recipe recipe;
  recipe.seed = 5;
  std::vector<LabelledModel> labels;
  int number = 0;
  for (int of = 1; of <= classes; ++of)
    for (int i = 0; i < of; ++i) {
      recipe.models.push_back({model_name(number), "/models/" + model_name(number)});
      labels.push_back({model_name(number++), {fmt::format("c{:02}", of), ""}, {}});
    }
  recipe.labels = Labels(labels);
  for (const char* name : {"clay", "glass", "gold", "steel"})
    recipe.materials.push_back(fmt::format("/a/{}.mat", name));
  recipe.environments = {"/e/attic", "/e/garden"};
  recipe.cameras.resize(3);
  recipe.view_names = {"0", "1", "2"};
  return recipe;
}

std::map<std::string, std::string> splits_of(const Recipe& recipe) {
  std::map<std::string, std::string> splits;
  for (const ImageSpec& image : expand(recipe))
    splits[image.id] = image.split;
  return splits;
}

TEST(Splits, StratifiedTakesTheShareOfEachClass) {
  Recipe recipe = recipe_of(23);
  recipe.split.stratified = true;
  for (const double share : {0.0, 0.05, 0.25, 0.5, 0.95, 1.0}) {
    recipe.split.test = share;
    std::map<std::string, std::map<std::string, std::set<std::string>>> of_class;
    for (const ImageSpec& image : expand(recipe))
      of_class[image.class_path][image.split].insert(image.model_name);
    for (auto& [path, models] : of_class) {
      const auto test = static_cast<double>(models["test"].size());
      const auto all = test + static_cast<double>(models["train"].size());
      double wanted = std::round(share * all);
      if (all > 1 && share > 0 && share < 1) wanted = std::clamp(wanted, 1.0, all - 1);
      EXPECT_EQ(test, wanted) << path << " " << share;
    }
  }
}

/// What hash gives is kept: the least hashes are test with and without.
TEST(Splits, StratifiedKeepsTheOrderOfHashes) {
  Recipe recipe = recipe_of(23);
  recipe.split.test = 0.25;
  const auto plain = splits_of(recipe);
  recipe.split.stratified = true;
  std::map<std::string, std::set<std::pair<std::string, std::string>>> moves;
  for (const ImageSpec& image : expand(recipe))
    if (*image.split != plain.at(image.id))
      moves[image.class_path].emplace(plain.at(image.id), *image.split);
  EXPECT_FALSE(moves.empty());
  for (const auto& [path, kinds] : moves)
    EXPECT_EQ(kinds.size(), 1U) << path << ": all that move go one way";
}

TEST(Splits, OneModelMoreMovesAtMostOneOfItsClass) {
  for (int more = 0; more < 50; ++more) {
    Recipe recipe = recipe_of(6);
    recipe.split.test = 0.2;
    recipe.split.stratified = true;
    const auto before = splits_of(recipe);
    std::vector<LabelledModel> labels;
    for (const ModelFile& model : recipe.models)
      labels.push_back({model.name, *recipe.labels.find(model.name), {}});
    const std::string added = fmt::format("x{}.off", more);
    labels.push_back({added, {"c03", ""}, {}});
    recipe.labels = Labels(labels);
    recipe.models.push_back({added, "/models/x.off"});
    std::set<std::string> moved;
    for (const ImageSpec& image : expand(recipe))
      if (const auto at = before.find(image.id); at != before.end() && at->second != *image.split)
        moved.insert(image.model_name);
    EXPECT_LE(moved.size(), 1U);
    for (const std::string& model : moved)
      EXPECT_EQ(recipe.labels.find(model)->class_path, "c03");
  }
}

TEST(Splits, OfMaterialsEnvironmentsAndViewsHaveBoth) {
  for (const SplitBy by : {SplitBy::material, SplitBy::environment, SplitBy::view})
    for (int seed = 0; seed < 20; ++seed) {
      Recipe recipe = recipe_of(4);
      recipe.assign_materials = recipe.assign_environments = Assign::all;
      recipe.seed = static_cast<std::uint64_t>(seed);
      recipe.split.by = by;
      recipe.split.test = 0.25;
      std::map<std::string, std::set<std::string>> of_thing;
      std::set<std::string> all;
      for (const ImageSpec& image : expand(recipe)) {
        of_thing[by == SplitBy::material      ? *image.material_name
                 : by == SplitBy::environment ? *image.environment_name
                                              : *image.view]
            .insert(image.split);
        all.insert(image.split);
      }
      EXPECT_EQ(all, (std::set<std::string>{"train", "test"}));
      for (const auto& [thing, splits] : of_thing)
        EXPECT_EQ(splits.size(), 1U) << thing;
    }
}

TEST(Splits, HeldOutAreTest) {
  Recipe recipe = recipe_of(3);
  recipe.split.by = SplitBy::environment;
  recipe.split.held_out = {"attic"};
  for (const ImageSpec& image : expand(recipe))
    EXPECT_EQ(*image.split, *image.environment_name == "attic" ? "test" : "train");
}

TEST(Splits, FoldsAreOfAllButTest) {
  Recipe recipe = recipe_of(40);  // 820 models
  recipe.split.folds = 5;
  std::map<std::string, std::uint64_t> before;
  std::map<std::uint64_t, int> sizes;
  for (const ImageSpec& image : expand(recipe)) {
    ASSERT_TRUE(image.fold);
    const auto [at, is_new] = before.try_emplace(image.model_name, *image.fold);
    EXPECT_EQ(at->second, *image.fold) << "all of a model are in one";
    sizes[*image.fold] += is_new ? 1 : 0;
  }
  ASSERT_EQ(sizes.size(), 5U);
  for (const auto& [fold, count] : sizes)
    EXPECT_NEAR(count, 164, 57) << fold;  // 5 standard deviations of a binomial(820, 0.2)
  recipe.split.test = 0.5;
  for (const ImageSpec& image : expand(recipe)) {
    EXPECT_EQ(image.fold.has_value(), *image.split == "train");
    if (image.fold) {
      EXPECT_EQ(*image.fold, before.at(image.model_name));
    }
  }
}

/// Folds by model.
std::map<std::string, std::uint64_t> folds_of(const Recipe& recipe) {
  std::map<std::string, std::uint64_t> folds;
  for (const ImageSpec& image : expand(recipe))
    if (image.fold) folds[image.model_name] = *image.fold;
  return folds;
}

TEST(Splits, StratifiedFoldsHaveOfEachClassAsManyGiveOrTakeOne) {
  Recipe recipe = recipe_of(23);
  for (const int folds : {2, 5, 10}) {
    recipe.split.folds = folds;
    for (const std::optional<double> test : {std::optional<double>(), std::optional(0.3)}) {
      recipe.split.test = test;
      recipe.split.stratified = false;
      const auto plain = folds_of(recipe);
      recipe.split.stratified = true;
      std::map<std::string, std::map<std::uint64_t, int>> counts;
      int moved = 0;
      for (const auto& [model, fold] : folds_of(recipe)) {
        ++counts[recipe.labels.find(model)->class_path][fold];
        const auto before = plain.find(model);
        moved += before != plain.end() && before->second != fold ? 1 : 0;
      }
      EXPECT_GT(moved, 0);
      EXPECT_LT(moved, 100) << "of 276: what hash gives is kept where it can be";
      for (const auto& [path, of_fold] : counts) {
        int all = 0, least = of_fold.begin()->second, most = 0;
        for (const auto& [fold, count] : of_fold) {
          all += count;
          least = std::min(least, count);
          most = std::max(most, count);
        }
        if (of_fold.size() < static_cast<std::size_t>(folds)) least = 0;
        EXPECT_LE(most - least, 1) << path << " in " << folds;
        EXPECT_EQ(most, (all + folds - 1) / folds);
      }
    }
  }
}

TEST(Splits, OneModelMoreMovesFewToOtherFolds) {
  Recipe recipe = recipe_of(20);
  recipe.split.folds = 4;
  recipe.split.stratified = true;
  const auto before = folds_of(recipe);
  std::vector<LabelledModel> labels;
  for (const ModelFile& model : recipe.models)
    labels.push_back({model.name, *recipe.labels.find(model.name), {}});
  int most = 0, all = 0;
  for (int more = 0; more < 50; ++more) {
    Recipe grown = recipe;
    const std::string added = fmt::format("x{}.off", more);
    std::vector<LabelledModel> listed = labels;
    listed.push_back({added, {"c19", ""}, {}});
    grown.labels = Labels(listed);
    grown.models.push_back({added, "/models/x.off"});
    int moved = 0;
    for (const auto& [model, fold] : folds_of(grown)) {
      const auto at = before.find(model);
      if (at == before.end() || at->second == fold) continue;
      ++moved;
      EXPECT_EQ(recipe.labels.find(model)->class_path, "c19");
    }
    most = std::max(most, moved);
    all += moved;
  }
  EXPECT_LE(most, 3);
  EXPECT_LT(all, 100) << "two each";
}

/// How often each candidate is chosen in each class and split.
std::map<std::pair<std::string, std::string>, std::map<std::string, int>> counts_of(
    const Recipe& recipe) {
  std::map<std::pair<std::string, std::string>, std::map<std::string, int>> counts;
  for (const ImageSpec& image : expand(recipe))
    ++counts[{image.class_path, image.split}][image.material_name];
  return counts;
}

TEST(Balanced, HasEachEquallyOftenInEachClassOfEachSplit) {
  Recipe recipe = recipe_of(20);
  recipe.split.test = 0.4;
  recipe.assign_materials = Assign::balanced;
  for (const ChoosePer per : {ChoosePer::model, ChoosePer::view}) {
    recipe.materials_per = per;
    const int unit = per == ChoosePer::model ? 3 : 1;  // images a choice
    for (const auto& [group, counts] : counts_of(recipe)) {
      int least = 1000, most = 0, sum = 0;
      for (const auto& path : recipe.materials) {
        const auto at = counts.find(material_name(path));
        const int count = at == counts.end() ? 0 : at->second;
        least = std::min(least, count);
        most = std::max(most, count);
        sum += count;
      }
      EXPECT_LE(most - least, unit) << group.first << " " << group.second << " of " << sum;
    }
  }
}

TEST(Balanced, OneModelMoreChangesOnlyItsClassAndSplit) {
  Recipe recipe = recipe_of(8);
  recipe.split.test = 0.4;
  recipe.assign_materials = Assign::balanced;
  std::map<std::string, std::string> before;
  for (const ImageSpec& image : expand(recipe))
    before[image.id] = image.material_name;
  std::vector<LabelledModel> labels;
  for (const ModelFile& model : recipe.models)
    labels.push_back({model.name, *recipe.labels.find(model.name), {}});
  labels.push_back({"x.off", {"c07", ""}, {}});
  recipe.labels = Labels(labels);
  recipe.models.push_back({"x.off", "/models/x.off"});
  const std::vector<ImageSpec> images = expand(recipe);
  const std::string split = std::find_if(images.begin(), images.end(), [](const ImageSpec& image) {
                              return *image.model_name == "x.off";
                            })->split;
  for (const ImageSpec& image : images)
    if (*image.class_path != "c07" || *image.split != split) {
      EXPECT_EQ(*image.material_name, before.at(image.id)) << image.id;
    }
}

class SplitKeysTest : public testing::Test {
 protected:
  RecipeFolder folder_;
};

TEST_F(SplitKeysTest, AreRead) {
  folder_.add("c.csv", "name,class\ncar,a\nmug,a\n");
  const Recipe recipe = folder_.read(
      "classes = { from = \"c.csv\", split = { test = 0.5, stratified = true, folds = 3 } }\n");
  EXPECT_EQ(recipe.split.test, 0.5);
  EXPECT_TRUE(recipe.split.stratified);
  EXPECT_EQ(recipe.split.folds, 3);
  EXPECT_THAT(canonical_recipe(recipe), HasSubstr("\nclasses.split.folds = 3\n"));
  EXPECT_THAT(folder_.read("classes.split = { by = \"environment\", held_out = [\"attic\"] }")
                  .split.held_out,
              ElementsAre("attic"));
}

TEST_F(SplitKeysTest, ThatCannotBeMeantAreNamed) {
  EXPECT_EQ(folder_.findings("classes.split = { by = \"enviroment\", test = 0.5 }"),
            "r.toml:4:24: classes.split.by must be \"model\" or \"material\" or \"environment\" or "
            "\"view\", got \"enviroment\", did you mean \"environment\"?");
  EXPECT_EQ(folder_.findings("classes.split = { by = \"environment\", held_out = [\"atic\"] }"),
            "r.toml:4:51: classes.split.held_out must name one of the recipe's environments, got "
            "\"atic\", did "
            "you mean attic?");
  EXPECT_EQ(
      folder_.findings("classes.split = { test = 0.5, held_out = [\"mug.off\"] }"),
      "r.toml:4:42: classes.split.held_out must not be given together with classes.split.test");
  EXPECT_EQ(folder_.findings("classes.split.by = \"view\""),
            "r.toml:4:20: classes.split.by has no effect without classes.split.test, "
            "classes.split.held_out or classes.split.folds");
  EXPECT_EQ(folder_.findings("classes.split.stratified = true"),
            "r.toml:4:28: classes.split.stratified has no effect without classes.split.test or "
            "classes.split.folds");
  EXPECT_EQ(folder_.findings("classes.split = { test = 0.5, stratified = true }"),
            "r.toml:4:44: classes.split.stratified = true wants classes: classes.from names them");
  EXPECT_THAT(folder_.findings("classes.split = { by = \"view\", test = 0.5, stratified = true }"),
              HasSubstr("classes.split.stratified has no effect with classes.split.by = \"view\""));
  EXPECT_EQ(folder_.findings("classes.split.folds = 1"),
            "r.toml:4:23: classes.split.folds must be an integer in [2, 1000], got 1");
  EXPECT_EQ(folder_.findings("classes.split.held_out = []"),
            "r.toml:4:26: classes.split.held_out must name something, got an empty list");
  EXPECT_EQ(folder_.findings("check.mask_least = 0.1"),
            "r.toml:4:20: check.mask_least is no key of a recipe, did you mean check.masks_least?");
}

}  // namespace
}  // namespace ds
