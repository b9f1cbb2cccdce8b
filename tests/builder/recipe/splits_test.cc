// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/splits.h"

#include "builder/recipe/seeded_hash.h"
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

/// With one more, of that class.
Recipe with_model(Recipe recipe, const std::string& name, const std::string& path) {
  std::vector<LabelledModel> labels{{name, {path, ""}, {}}};
  for (const ModelFile& model : recipe.models)
    labels.push_back({model.name, *recipe.labels.find(model.name), {}});
  recipe.labels = Labels(labels);
  recipe.models.push_back({name, "/models/" + name});
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
    recipe = with_model(recipe, fmt::format("x{}.off", more), "c03");
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

/// Models by split.
std::map<std::string, std::set<std::string>> models_of(const Recipe& recipe) {
  std::map<std::string, std::set<std::string>> models;
  for (const ImageSpec& image : expand(recipe))
    models[image.split].insert(image.model_name);
  return models;
}

TEST(Splits, ValTakesNothingFromTest) {
  Recipe recipe = recipe_of(40);  // 820 models
  for (const bool stratified : {false, true}) {
    recipe.split = {};
    recipe.split.stratified = stratified;
    recipe.split.test = 0.15;
    const auto two = models_of(recipe);
    recipe.split.val = 0.15;
    auto three = models_of(recipe);
    EXPECT_EQ(three.at("test"), two.at("test"));
    EXPECT_EQ(three.size(), 3U);
    // 5 standard deviations of a binomial(820, 0.15)
    EXPECT_NEAR(static_cast<double>(three.at("val").size()), 123, 51);
    three.at("val").merge(three.at("train"));
    EXPECT_EQ(three.at("val"), two.at("train"));
  }
}

/// The rule as it is documented, from the hash itself.
TEST(Splits, ByHashAreIntervalsOfIt) {
  Recipe recipe = recipe_of(20);
  recipe.split.test = 0.2;
  recipe.split.val = 0.3;
  for (const ImageSpec& image : expand(recipe)) {
    const double at = static_cast<double>(seeded_hash(5, "split", {*image.model_name}) >> 11U) /
                      9007199254740992.0;
    EXPECT_EQ(*image.split, at < 0.2 ? "test" : at < 0.5 ? "val" : "train");
  }
}

TEST(Splits, StratifiedTakesThreeSharesOfEachClass) {
  Recipe recipe = recipe_of(30);
  recipe.split.stratified = true;
  recipe.split.test = recipe.split.val = 0.15;
  std::map<std::string, std::map<std::string, std::set<std::string>>> of_class;
  for (const ImageSpec& image : expand(recipe))
    of_class[image.class_path][image.split].insert(image.model_name);
  int size = 0;
  for (auto& [path, models] : of_class) {
    ++size;  // c01 has one, c02 two, ...
    double test = std::floor(0.15 * size + 0.5), both = std::floor(0.3 * size + 0.5);
    if (size > 1) test = std::max(test, 1.0);
    if (size > 2) both = std::max(both, test + 1);
    both = std::max(both, test);
    EXPECT_EQ(models["test"].size(), test) << path;
    EXPECT_EQ(models["val"].size(), both - test) << path;
    EXPECT_EQ(models["train"].size(), size - both) << path;
  }
  EXPECT_EQ(size, 30);
}

TEST(Splits, OneModelMoreMovesOneOfEachSplitAtMost) {
  for (int more = 0; more < 50; ++more) {
    Recipe recipe = recipe_of(12);
    recipe.split.test = recipe.split.val = 0.2;
    recipe.split.stratified = true;
    const auto before = splits_of(recipe);
    recipe = with_model(recipe, fmt::format("x{}.off", more), "c11");
    std::map<std::string, std::set<std::string>> moved;
    for (const ImageSpec& image : expand(recipe))
      if (const auto at = before.find(image.id); at != before.end() && at->second != *image.split) {
        moved[at->second].insert(image.model_name);
        EXPECT_EQ(*image.class_path, "c11");
      }
    for (const auto& [split, models] : moved)
      EXPECT_LE(models.size(), 1U) << split;
  }
}

TEST(Splits, OfFewThingsHaveAllThree) {
  for (const SplitBy by : {SplitBy::model_class, SplitBy::material, SplitBy::view})
    for (int seed = 0; seed < 20; ++seed) {
      Recipe recipe = recipe_of(4);  // 4 classes, 4 materials, 3 views
      recipe.assign_materials = Assign::all;
      recipe.seed = static_cast<std::uint64_t>(seed);
      recipe.split.by = by;
      recipe.split.test = 0.15;
      recipe.split.val = 0.15;
      std::map<std::string, std::set<std::string>> of_thing;
      std::set<std::string> all;
      for (const ImageSpec& image : expand(recipe)) {
        of_thing[by == SplitBy::model_class ? *image.class_path
                 : by == SplitBy::material  ? *image.material_name
                                            : *image.view]
            .insert(image.split);
        all.insert(image.split);
      }
      EXPECT_EQ(all, (std::set<std::string>{"train", "val", "test"}));
      for (const auto& [thing, splits] : of_thing)
        EXPECT_EQ(splits.size(), 1U) << thing;
    }
}

TEST(Splits, OfClassesAreTheModelsSplits) {
  Recipe recipe = recipe_of(9);
  recipe.split.by = SplitBy::model_class;
  recipe.split.test = 0.3;
  recipe.split.folds = 3;
  const Splits splits(recipe);
  std::map<std::string, std::optional<std::uint64_t>> folds;
  for (const ImageSpec& image : expand(recipe)) {
    EXPECT_EQ(splits.of_model(image.model_name).split, *image.split);
    EXPECT_EQ(image.fold.has_value(), *image.split == "train");
    EXPECT_EQ(folds.try_emplace(image.class_path, image.fold).first->second, image.fold);
  }
  // One class more moves no other.
  const auto before = splits_of(recipe);
  recipe = with_model(with_model(recipe, "x.off", "x"), "none.off", "");
  for (const ImageSpec& image : expand(recipe))
    if (const auto at = before.find(image.id); at != before.end()) {
      EXPECT_EQ(at->second, *image.split);
    } else if (*image.model_name == "none.off") {
      EXPECT_EQ(*image.split, "") << "of no class";
      EXPECT_FALSE(image.fold);
    }
}

TEST(Splits, HeldOutMayBeBothAndLeaveValAShare) {
  Recipe recipe = recipe_of(3);
  recipe.split.by = SplitBy::material;
  recipe.assign_materials = Assign::all;
  recipe.split.held_out = {"gold"};
  recipe.split.held_out_val = {"clay"};
  for (const ImageSpec& image : expand(recipe))
    EXPECT_EQ(*image.split, *image.material_name == "gold"   ? "test"
                            : *image.material_name == "clay" ? "val"
                                                             : "train");
  recipe.split.held_out_val = {};
  recipe.split.val = 0.3;
  std::set<std::string> val;
  for (const ImageSpec& image : expand(recipe)) {
    EXPECT_EQ(*image.split == "test", *image.material_name == "gold");
    if (*image.split == "val") val.insert(image.material_name);
  }
  EXPECT_TRUE(val.size() == 1 || val.size() == 2) << val.size();
}

TEST(Splits, ValTakesOfWhatFilesTrain) {
  Recipe recipe = recipe_of(30);
  std::vector<LabelledModel> labels;
  for (const ModelFile& model : recipe.models) {
    ModelLabel label = *recipe.labels.find(model.name);
    label.split = labels.size() % 3 == 0 ? "test" : "train";
    labels.push_back({model.name, label, {}});
  }
  recipe.labels = Labels(labels);
  const auto told = models_of(recipe);
  recipe.split.val = 0.2;
  recipe.split.stratified = true;
  auto dealt = models_of(recipe);
  EXPECT_EQ(dealt.at("test"), told.at("test"));
  std::map<std::string, std::pair<int, int>> of_class;  // all but test, val
  for (const std::string& model : told.at("train")) {
    auto& [all, val] = of_class[recipe.labels.find(model)->class_path];
    ++all;
    val += dealt.at("val").contains(model) ? 1 : 0;
  }
  for (const auto& [path, counts] : of_class) {
    const double wanted = std::floor(0.2 * counts.first + 0.5);
    EXPECT_EQ(counts.second, counts.first > 1 ? std::max(wanted, 1.0) : wanted) << path;
  }
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
  recipe.split.val = 0.1;
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
            "r.toml:4:24: classes.split.by must be \"model\" or \"class\" or \"material\" or "
            "\"environment\" or \"view\", got \"enviroment\", did you mean \"environment\"?");
  EXPECT_EQ(folder_.findings("classes.split = { by = \"environment\", held_out = [\"atic\"] }"),
            "r.toml:4:51: classes.split.held_out must name one of the recipe's environments, got "
            "\"atic\", did "
            "you mean attic?");
  EXPECT_EQ(
      folder_.findings("classes.split = { test = 0.5, held_out = [\"mug.off\"] }"),
      "r.toml:4:42: classes.split.held_out must not be given together with classes.split.test");
  EXPECT_EQ(folder_.findings("classes.split.by = \"view\""),
            "r.toml:4:20: classes.split.by has no effect without test, val, held_out or folds of "
            "classes.split");
  EXPECT_EQ(folder_.findings("classes.split.stratified = true"),
            "r.toml:4:28: classes.split.stratified has no effect without test, val or folds of "
            "classes.split");
  EXPECT_EQ(folder_.findings("classes.split = { test = 0.5, stratified = true }"),
            "r.toml:4:44: classes.split.stratified = true wants classes: classes.from names them");
  EXPECT_THAT(folder_.findings("classes.split = { by = \"view\", test = 0.5, stratified = true }"),
              HasSubstr("classes.split.stratified has no effect with classes.split.by = \"view\""));
  EXPECT_EQ(folder_.findings("classes.split.folds = 1"),
            "r.toml:4:23: classes.split.folds must be an integer in [2, 1000], got 1");
  EXPECT_EQ(folder_.findings("classes.split.held_out = []"),
            "r.toml:4:26: classes.split.held_out must name something, got an empty list");
  EXPECT_EQ(folder_.findings("classes.split = { test = 0.6, val = 0.5 }"),
            "r.toml:4:37: classes.split.val and classes.split.test must be 1 at most together, got "
            "1.1");
  EXPECT_EQ(folder_.findings("classes.split = { train = 0.7, val = 0.15, test = 0.15 }"), "");
  EXPECT_EQ(folder_.findings("classes.split = { train = 0.8, val = 0.15, test = 0.15 }"),
            "r.toml:4:27: classes.split.train must be what classes.split.test and val leave, 0.7, "
            "got 0.8");
  EXPECT_EQ(folder_.findings("classes.split.train = 0.8"),
            "r.toml:4:23: classes.split.train has no effect without classes.split.test or "
            "classes.split.val");
  EXPECT_EQ(folder_.findings("classes.split = { by = \"class\", test = 0.5 }"),
            "r.toml:4:24: classes.split.by = \"class\" wants classes: classes.from names them");
  EXPECT_EQ(folder_.findings("classes.split = { by = \"environment\", held_out = [\"attic\"], "
                             "held_out_val = [\"attic\"] }"),
            "r.toml:4:76: classes.split.held_out_val must not name what held_out does, got "
            "\"attic\"");
  EXPECT_EQ(folder_.findings("classes.split = { test = 0.5, held_out_val = [\"mug.off\"] }"),
            "r.toml:4:46: classes.split.held_out_val must not be given together with "
            "classes.split.test");
  folder_.add("n.csv", "name,class\ncar,a/b\nmug,a/c\ntree,d\n");
  const std::string nested =
      "classes.from = \"n.csv\"\nclasses.split = { by = \"class\", held_out = ";
  for (const ImageSpec& image : expand(folder_.read(nested + "[\"a\"] }")))
    EXPECT_EQ(*image.split, *image.class_path == "d" ? "train" : "test");
  EXPECT_EQ(folder_.findings(nested + "[\"b\"] }"),
            "r.toml:5:45: classes.split.held_out must name one of the recipe's classes, got \"b\"");
  folder_.add("s.csv", "name,class,split\ncar,a,train\nmug,a,test\ntree,a,train\n");
  const std::string told = "classes.from = \"s.csv\"\nclasses.split = { ";
  EXPECT_EQ(folder_.findings(told + "val = 0.5 }"), "");
  EXPECT_THAT(folder_.findings(told + "val = 0.5, by = \"view\" }"),
              HasSubstr("classes.split.val wants classes.split.by = \"model\" where classes.from "
                        "says what is train and test, got \"view\""));
  EXPECT_EQ(folder_.findings("check.mask_least = 0.1"),
            "r.toml:4:20: check.mask_least is no key of a recipe, did you mean check.masks_least?");
}

}  // namespace
}  // namespace ds
