// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/recipe.h"
#include "tests/builder/recipe_folder.h"
#include "tracer/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

namespace ds {
namespace {

using testing::ElementsAre;

/// A recipe without files: `expand` looks at names only.
Recipe small_recipe(int model_count = 3, int view_count = 2) {
  Recipe recipe;
  recipe.seed = 5;
  for (int i = 0; i < model_count; ++i)
    recipe.models.push_back({fmt::format("m{}.off", i), fmt::format("/models/m{}.off", i)});
  recipe.materials = {"/a/clay.mat", "/a/glass.mat", "/a/steel.mat"};
  recipe.environments = {"/e/attic", "/e/garden"};
  for (int i = 0; i < view_count; ++i) {
    recipe.cameras.emplace_back();
    recipe.view_names.push_back(std::to_string(i));
  }
  return recipe;
}

std::string describe(const ImageSpec& image) {
  return fmt::format("{} {} {} {} {} {} {}", image.id, image.model_file->string(),
                     image.material_file->string(), image.environment_folder->string(),
                     *image.split, image.engine.seed, *image.class_path);
}

std::map<std::string, std::string> by_id(const Recipe& recipe) {
  std::map<std::string, std::string> images;
  for (const ImageSpec& image : expand(recipe))
    images[image.id] = describe(image);
  return images;
}

/// Every image of `before` is the same in `after`.
void expect_kept(const Recipe& before, const Recipe& after) {
  const auto all = by_id(after);
  for (const auto& [id, image] : by_id(before)) {
    ASSERT_TRUE(all.contains(id)) << id;
    EXPECT_EQ(all.at(id), image);
  }
}

TEST(Expand, OrdersByModelNameThenView) {
  Recipe recipe = small_recipe();
  std::swap(recipe.models[0], recipe.models[2]);
  std::vector<std::string> ids;
  for (const ImageSpec& image : expand(recipe))
    ids.push_back(image.id);
  EXPECT_THAT(ids,
              ElementsAre("m0.off/0", "m0.off/1", "m1.off/0", "m1.off/1", "m2.off/0", "m2.off/1"));
}

TEST(Expand, FillsInEachImage) {
  Recipe recipe = small_recipe();
  recipe.cameras[1].fov_deg = 33;
  recipe.engine.spp = 9;
  const ImageSpec image = expand(recipe)[1];
  EXPECT_EQ(image.model_name, "m0.off");
  EXPECT_EQ(image.model_file, "/models/m0.off");
  EXPECT_EQ(image.material_name, image.material_file->stem());
  EXPECT_EQ(image.environment_name, image.environment_folder->filename());
  EXPECT_EQ(image.view, "1");
  EXPECT_EQ(image.camera.fov_deg, 33);
  EXPECT_EQ(image.engine.spp, 9);
  EXPECT_EQ(image.class_path, "");
  EXPECT_EQ(image.split, "");
}

TEST(Expand, OfModelsOwnMaterialsEachHasItsOwn) {
  Recipe recipe = small_recipe();
  recipe.assign_materials = Assign::own;
  for (const bool with_files : {true, false}) {
    if (!with_files) recipe.materials.clear();
    const std::vector<ImageSpec> images = expand(recipe);
    ASSERT_EQ(images.size(), 6U);
    EXPECT_EQ(image_count(recipe), 6U);
    for (const ImageSpec& image : images) {
      EXPECT_TRUE(shows_own(image));
      EXPECT_EQ(image.material_file, image.model_file);
      EXPECT_EQ(image.material_name, "own");
    }
  }
  for (const ImageSpec& image : expand(small_recipe()))
    EXPECT_FALSE(shows_own(image));
  EXPECT_FALSE(shows_own(ImageSpec{}));
}

TEST(Expand, IsPure) {
  EXPECT_EQ(by_id(small_recipe()), by_id(small_recipe()));
}

TEST(Expand, AddingAModelChangesNoOtherImage) {
  for (const Assign materials : {Assign::random, Assign::cycle, Assign::all}) {
    for (const Assign environments : {Assign::random, Assign::cycle, Assign::all}) {
      Recipe before = small_recipe(30, 5);
      before.assign_materials = materials;
      before.assign_environments = environments;
      before.split.test = 0.5;
      Recipe after = before;
      after.models.insert(after.models.begin(), {"a-first.off", "/models/a-first.off"});
      after.models.push_back({"z-last.off", "/models/z-last.off"});
      expect_kept(before, after);
    }
  }
}

TEST(Expand, LeavingOutViewsChangesNoOtherImage) {
  for (const Assign assign : {Assign::random, Assign::cycle}) {
    Recipe all = small_recipe(10, 5);
    all.assign_materials = all.assign_environments = assign;
    all.materials_per = ChoosePer::view;
    Recipe some = all;
    some.cameras.resize(2);
    some.view_names = {"1", "4"};
    expect_kept(some, all);
  }
}

TEST(Expand, AddingAMaterialMovesOnlyToIt) {
  Recipe before = small_recipe(200, 2);
  Recipe after = before;
  after.materials.insert(after.materials.begin(), "/a/brass.mat");
  const auto old_images = expand(before), new_images = expand(after);
  int moved = 0;
  for (std::size_t i = 0; i < old_images.size(); ++i) {
    if (old_images[i].material_name == new_images[i].material_name) continue;
    EXPECT_EQ(new_images[i].material_name, "brass");
    ++moved;
  }
  // A quarter of 200 models with 2 images each; 5 standard deviations of a binomial(200, 1/4) are
  // 31 models.
  EXPECT_NEAR(moved / 2, 50, 31);
}

TEST(Expand, RandomGivesOneMaterialAModelOrOneAView) {
  Recipe recipe = small_recipe(300, 14);
  std::map<std::string, std::set<std::string>> of_model;
  std::map<std::string, int> models_of;
  for (const ImageSpec& image : expand(recipe)) {
    of_model[*image.model_name].insert(*image.material_name);
    if (image.view == "0") ++models_of[*image.material_name];
  }
  for (const auto& [model, materials] : of_model)
    EXPECT_EQ(materials.size(), 1u) << model;
  // 300 models to 3 materials: 5 standard deviations of a binomial(300, 1/3) are 41.
  for (const auto& [material, count] : models_of)
    EXPECT_NEAR(count, 100, 41) << material;

  recipe.materials_per = ChoosePer::view;
  of_model.clear();
  for (const ImageSpec& image : expand(recipe))
    of_model[*image.model_name].insert(*image.material_name);
  int with_all = 0;
  for (const auto& [model, materials] : of_model)
    with_all += materials.size() == 3 ? 1 : 0;
  EXPECT_GT(with_all, 250);  // all three appear in 14 views with probability 0.99
}

TEST(Expand, CycleTakesOneAfterTheOtherFromAStartOfTheModelsOwn) {
  Recipe recipe = small_recipe(100, 6);
  recipe.assign_materials = Assign::cycle;
  std::map<std::string, int> starts;
  const auto images = expand(recipe);
  for (std::size_t i = 0; i < images.size(); i += 6) {
    ++starts[*images[i].material_name];
    for (std::size_t view = 0; view + 3 < 6; ++view) {
      EXPECT_EQ(images[i + view].material_name, images[i + view + 3].material_name);
      EXPECT_NE(images[i + view].material_name, images[i + view + 1].material_name);
    }
  }
  EXPECT_EQ(starts.size(), 3u);
}

TEST(Expand, AllMakesAnImageForEachAndNamesIt) {
  Recipe recipe = small_recipe(1, 1);
  recipe.assign_materials = Assign::all;
  recipe.assign_environments = Assign::all;
  std::vector<std::string> ids;
  for (const ImageSpec& image : expand(recipe))
    ids.push_back(image.id);
  EXPECT_THAT(
      ids, ElementsAre("m0.off/0-clay-attic", "m0.off/0-clay-garden", "m0.off/0-glass-attic",
                       "m0.off/0-glass-garden", "m0.off/0-steel-attic", "m0.off/0-steel-garden"));
  recipe.assign_environments = Assign::cycle;
  EXPECT_EQ(expand(recipe)[1].id, "m0.off/0-glass");
  recipe.assign_materials = Assign::random;
  recipe.assign_environments = Assign::all;
  EXPECT_EQ(expand(recipe)[1].id, "m0.off/0-garden");
}

TEST(Expand, CountsItsImagesBeforeItMakesThem) {
  Recipe recipe = small_recipe(3, 4);
  for (const Assign materials : {Assign::random, Assign::cycle, Assign::all})
    for (const Assign environments : {Assign::random, Assign::cycle, Assign::all}) {
      recipe.assign_materials = materials;
      recipe.assign_environments = environments;
      EXPECT_EQ(image_count(recipe), expand(recipe).size());
    }
}

TEST(Expand, RefusesTwoImagesOfOneName) {
  Recipe recipe = small_recipe(1, 1);
  recipe.models.push_back({"m0.off", "/elsewhere/m0.off"});
  EXPECT_THROW(expand(recipe), Error);
  recipe = small_recipe(1, 1);
  recipe.assign_materials = recipe.assign_environments = Assign::all;
  recipe.materials = {"/a/x.mat", "/a/x-y.mat"};
  recipe.environments = {"/e/y-z", "/e/z"};
  EXPECT_THROW(expand(recipe), Error);
}

TEST(Expand, GivesEachImageASeedOfItsOwnBelow2To53) {
  Recipe recipe = small_recipe(100, 14);
  std::set<std::uint64_t> seeds;
  for (const ImageSpec& image : expand(recipe)) {
    EXPECT_LT(image.engine.seed, std::uint64_t{1} << 53);
    EXPECT_TRUE(seeds.insert(image.engine.seed).second);
  }
  recipe.seed = 6;
  for (const ImageSpec& image : expand(recipe))
    EXPECT_TRUE(seeds.insert(image.engine.seed).second);
}

TEST(Expand, SplitsModelsByTheShareAskedFor) {
  Recipe recipe = small_recipe(1000, 2);
  recipe.split.test = 0.3;
  std::map<std::string, std::set<std::string>> splits;
  for (const ImageSpec& image : expand(recipe))
    splits[*image.model_name].insert(*image.split);
  int in_test = 0;
  for (const auto& [model, split] : splits) {
    ASSERT_EQ(split.size(), 1u) << model;
    in_test += *split.begin() == "test" ? 1 : 0;
  }
  EXPECT_NEAR(in_test, 300, 73);  // 5 standard deviations of a binomial(1000, 0.3)

  // A larger share moves models one way only.
  Recipe larger = recipe;
  larger.split.test = 0.5;
  for (const ImageSpec& image : expand(larger)) {
    if (splits[*image.model_name].contains("test")) {
      EXPECT_EQ(image.split, "test");
    }
  }
  recipe.split.test = 0;
  EXPECT_EQ(expand(recipe)[0].split, "train");
  recipe.split.test = 1;
  EXPECT_EQ(expand(recipe)[0].split, "test");
}

// Choices and seeds are part of every dataset made: these may change only with a note to every
// user.
TEST(Expand, KeepsTheChoicesOfFormerVersions) {
  Recipe recipe = small_recipe(2, 2);
  recipe.split.test = 0.5;
  std::vector<std::string> images;
  for (const ImageSpec& image : expand(recipe))
    images.push_back(describe(image));
  EXPECT_THAT(images,
              ElementsAre("m0.off/0 /models/m0.off /a/clay.mat /e/attic test 6562786626549289 ",
                          "m0.off/1 /models/m0.off /a/clay.mat /e/garden test 7040878465826518 ",
                          "m1.off/0 /models/m1.off /a/steel.mat /e/attic test 6217639660125446 ",
                          "m1.off/1 /models/m1.off /a/steel.mat /e/garden test 8004397243485423 "));
}

}  // namespace
}  // namespace ds
