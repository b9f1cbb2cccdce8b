// SPDX-License-Identifier: Apache-2.0
// Copies of models planted in folds, splits and classes, as a recipe that draws sizes and turns shows them; and
// licences that do not go with the dataset's.
#include "manifests/check/check.h"
#include "manifests/check/meshes.h"
#include "tracer/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace ds {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// A shape of 19 numbers, all alike but for the first; the unit of both is 1e-4.
std::string shape_text(int first, int others = 4096) {
  std::string text = fmt::format("{:04x}", first);
  for (int i = 1; i < 19; ++i)
    text += fmt::format("{:04x}", others);
  return text;
}

/// 2 classes of 4 models of different shapes, one view each; each as turned and scaled by itself.
CheckInput varied() {
  CheckInput input;
  int number = 0;
  for (const char* name : {"cup", "mug"})
    for (int model = 0; model < 4; ++model) {
      ImageRecord image;
      image.model = fmt::format("{}-{}.ply", name, model);
      image.id = image.model + "/0";
      image.class_path = name;
      image.parts[0] = hash_text(image.id + " turned");
      image.pose = ModelPose{{}, {{0, 0, 0}, {1, 2, 3.0 + ++number}}};
      image.files.push_back({image.id + ".png", "image", {}, hash_text(image.id)});
      input.dataset.shapes[image.model] = shape_text(1000 * number);
      input.images.push_back(std::move(image));
    }
  return input;
}

ImageRecord& show(CheckInput& input, const std::string& model) {
  for (ImageRecord& image : input.images)
    if (image.model == model) return image;
  throw std::logic_error("no image of it");
}

/// `copy` has the bytes of `model`: shape and box, but another turn.
void plant_copy(CheckInput& input, const std::string& model, const std::string& copy) {
  show(input, copy).pose = show(input, model).pose;
  input.dataset.shapes[copy] = input.dataset.shapes[model];
}

/// `copy` is `model` turned: the shape's digits may round otherwise, and the box is another.
void plant_turned(CheckInput& input, const std::string& model, const std::string& copy,
                  int rounding) {
  show(input, copy).pose->model_box = {{-1, -1, -1}, {1, 1, 1.5}};
  const int first = std::stoi(input.dataset.shapes[model].substr(0, 4), nullptr, 16);
  input.dataset.shapes[copy] = shape_text(first + rounding);
}

void fold(CheckInput& input, const std::string& model, std::optional<std::uint64_t> fold) {
  show(input, model).fold = fold;
}

CheckInput folded() {
  CheckInput input = varied();
  std::uint64_t number = 0;
  for (ImageRecord& image : input.images)
    image.fold = number++ % 2;
  return input;
}

std::vector<std::string> told(const CheckInput& input, const std::string& check,
                              CheckLevel least = CheckLevel::warning) {
  std::vector<std::string> lines;
  for (const CheckFinding& finding : run_checks(input, {check}))
    if (finding.level >= least)
      lines.push_back(fmt::format("{}: {}/{} {}: {}", name_of(finding.level), finding.count,
                                  finding.of, finding.what, fmt::join(finding.examples, "; ")));
  return lines;
}

TEST(Copies, NoneIsFoundWhereNoneIs) {
  for (const char* check : {"labels", "leaks", "balance", "duplicates"}) {
    EXPECT_THAT(told(varied(), check), IsEmpty()) << check;
    EXPECT_THAT(told(folded(), check), IsEmpty()) << check;
  }
}

TEST(Copies, InTwoFolds) {
  CheckInput input = folded();
  plant_copy(input, "mug-0.ply", "mug-1.ply");
  EXPECT_THAT(told(input, "leaks"),
              ElementsAre("error: 1/7 models are the same mesh in two folds: mug-0.ply (fold 0), "
                          "mug-1.ply (fold 1): the same or mirrored"));
  fold(input, "mug-1.ply", 0);
  EXPECT_THAT(told(input, "leaks"), IsEmpty()) << "in one fold it is no leak";
  input = folded();
  plant_turned(input, "cup-0.ply", "cup-1.ply", 1);
  EXPECT_THAT(told(input, "leaks"),
              ElementsAre(HasSubstr("warning: 1/16 pairs of models in two folds have nearly one "
                                    "shape")));
  EXPECT_EQ(run_checks(input, {"leaks"}).at(0).images.size(), 2U);
}

TEST(Copies, InFoldsBesideATest) {
  CheckInput input = folded();
  for (const char* model : {"cup-3.ply", "mug-3.ply"}) {
    show(input, model).split = "test";
    fold(input, model, std::nullopt);
  }
  for (ImageRecord& image : input.images)
    if (image.fold) image.split = "train";
  plant_copy(input, "mug-0.ply", "mug-1.ply");
  plant_copy(input, "cup-0.ply", "cup-3.ply");
  EXPECT_THAT(told(input, "leaks"),
              ElementsAre("error: 1/6 models are the same mesh in two splits: cup-3.ply (test), "
                          "cup-0.ply (train): the same or mirrored",
                          "error: 1/5 models are the same mesh in two folds: mug-0.ply (fold 0), "
                          "mug-1.ply (fold 1): the same or mirrored"));
}

TEST(Copies, DistractorsPicturesAndClassesOfFolds) {
  CheckInput input = folded();
  ObjectRecord object;
  object.model = "mug-1.ply";
  object.pose = *show(input, "mug-1.ply").pose;
  show(input, "cup-0.ply").objects = {object};
  EXPECT_THAT(told(input, "leaks"),
              ElementsAre("error: 1/1 images show a model of another fold as a distractor: "
                          "cup-0.ply/0"));
  input = folded();
  show(input, "mug-1.ply").files[0].pixels = show(input, "mug-0.ply").files[0].pixels;
  EXPECT_THAT(told(input, "duplicates"),
              ElementsAre("error: 1/8 pictures have the pixels of one in another fold: "
                          "mug-1.ply/0 as mug-0.ply/0"));
  for (const char* model : {"mug-1.ply", "mug-3.ply"})
    fold(input, model, 0);
  EXPECT_THAT(told(input, "balance"),
              ElementsAre("error: 1/2 classes have images in one fold only: mug (fold 0)"));
  EXPECT_THAT(told(input, "duplicates"),
              ElementsAre(HasSubstr("warning: 1/8 pictures have the pixels of another: ")));
}

TEST(Copies, FoldsOfViewsShareModels) {
  CheckInput input = folded();
  input.images.push_back(show(input, "mug-0.ply"));
  input.images.back().id = "mug-0.ply/1";
  input.images.back().fold = 1;
  input.dataset.recipe_text = "classes.split.by = \"view\"\n";
  EXPECT_THAT(told(input, "leaks"), IsEmpty());
  EXPECT_EQ(run_checks(input, {"leaks"}).front().what, "1 of 8 models are in more than one fold");
}

TEST(Copies, OfVariedModelsAreErrors) {
  CheckInput input = varied();
  plant_copy(input, "mug-0.ply", "cup-2.ply");
  EXPECT_THAT(told(input, "labels"),
              ElementsAre("error: 1/7 models are the same mesh in two classes: cup-2.ply (cup), "
                          "mug-0.ply (mug): the same or mirrored"));
  for (ImageRecord& image : input.images)
    image.split = image.class_path == "mug" ? "train" : "test";
  EXPECT_THAT(told(input, "leaks"),
              ElementsAre("error: 1/7 models are the same mesh in two splits: cup-2.ply (test), "
                          "mug-0.ply (train): the same or mirrored"));
}

TEST(Copies, AModelThatIsTurnedInEachImageIsOne) {
  CheckInput input = varied();
  input.images.push_back(show(input, "mug-0.ply"));
  input.images.back().id = "mug-0.ply/1";
  input.images.back().parts[0] = hash_text("turned otherwise");
  plant_copy(input, "mug-0.ply", "cup-2.ply");
  EXPECT_THAT(told(input, "labels"), ElementsAre(HasSubstr("error: 1/7 models are the same mesh")));
  // By parts alone, as without poses: of two images of a model either may meet the copy's.
  input = varied();
  input.images.push_back(show(input, "mug-0.ply"));
  input.images.back().id = "mug-0.ply/1";
  input.images.back().parts[0] = show(input, "cup-1.ply").parts[0];
  EXPECT_THAT(
      told(input, "labels"),
      ElementsAre(HasSubstr("error: 1/7 models are the same mesh in two classes: cup-1.ply")));
}

TEST(Copies, TurnedOnesInTwoClasses) {
  for (const int rounding : {0, 1}) {
    CheckInput input = varied();
    plant_turned(input, "mug-1.ply", "cup-2.ply", rounding);
    const std::vector<std::string> lines = told(input, "labels");
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_THAT(lines[0], HasSubstr("warning: 1/16 pairs of models in two classes have nearly one "
                                    "shape, as turned, scaled or remeshed copies have: "));
    EXPECT_THAT(lines[0], HasSubstr("mug-1.ply (mug)"));
    EXPECT_THAT(lines[0], HasSubstr("cup-2.ply (cup)"));
    input.dataset.recipe_text = "check.leaks_near_shape = 0\n";
    EXPECT_THAT(told(input, "labels"), IsEmpty());
    input.dataset.recipe_text.clear();
    show(input, "cup-2.ply").class_path = "mug";
    EXPECT_THAT(told(input, "labels"), IsEmpty()) << "one class";
  }
}

TEST(Copies, NoEmptyBrackets) {
  CheckInput input = varied();
  for (ImageRecord& image : input.images)
    if (image.class_path == "mug") image.split = "train";
  plant_copy(input, "mug-1.ply", "cup-2.ply");
  EXPECT_THAT(told(input, "balance"),
              ElementsAre("error: 2/2 classes have images in one split only: cup; mug (train)"));
  EXPECT_THAT(told(input, "leaks"), ElementsAre(HasSubstr(": cup-2.ply, mug-1.ply (train)")));
}

/// All models of `varied` with a licence, and the one environment and material, which have no name.
CheckInput licensed(const std::string& own, const std::string& of_models) {
  CheckInput input = varied();
  input.dataset.licence = own;
  input.dataset.licences = {{of_models, "text", {}},
                            {"CC0-1.0", "text", {"environments/e", "materials/m.mat"}}};
  for (ImageRecord& image : input.images) {
    image.environment = "e";
    image.material = "m";
    input.dataset.licences[0].assets.push_back("models/" + image.model);
  }
  return input;
}

TEST(DatasetLicences, AllowNoMoreThanTheAssets) {
  const CheckInput input = licensed("CC-BY-4.0", "CC-BY-NC-4.0");
  EXPECT_THAT(told(input, "licences"),
              ElementsAre("warning: 1/2 licences of models and scenes allow less than the "
                          "dataset's, CC-BY-4.0: CC-BY-NC-4.0 (not commercial use)"));
  EXPECT_EQ(run_checks(input, {"licences"}).at(0).images.size(), 8U);
  EXPECT_THAT(told(input, "licences", CheckLevel::note),
              testing::Contains("note: 1/2 licences of models and scenes have limits: no commerce, "
                                "no changes, or the same licence only: CC-BY-NC-4.0"));
  for (const auto& [own, of_models, wanted] :
       {std::tuple{"CC0-1.0", "CC-BY-4.0", "(not use without a name)"},
        std::tuple{"cc-by-4.0", "CC-BY-SA-4.0", "(not another licence)"},
        std::tuple{"CC-BY-NC-4.0", "CC-BY-NC-ND-4.0", "(not changes)"},
        std::tuple{"MIT", "GPL-3.0-only", "(not another licence)"}})
    EXPECT_THAT(told(licensed(own, of_models), "licences"), ElementsAre(HasSubstr(wanted))) << own;
  for (const auto& [own, of_models] :
       {std::pair{"CC-BY-NC-4.0", "CC-BY-4.0"}, std::pair{"CC-BY-SA-4.0", "CC-BY-SA-4.0"},
        std::pair{"CC-BY-NC-4.0", "CC-BY-NC-4.0"}, std::pair{"my own words", "CC-BY-NC-4.0"},
        std::pair{"", "CC-BY-NC-4.0"}, std::pair{"MIT", "CC0-1.0"}, std::pair{"CC-BY-4.0", ""}})
    EXPECT_THAT(told(licensed(own, of_models), "licences"), IsEmpty()) << own << " " << of_models;
}

TEST(DatasetLicences, AssetsWithoutOneAreToldWhateverTheDatasets) {
  CheckInput input = licensed("CC-BY-4.0", "");
  std::erase_if(input.dataset.licences[0].assets,
                [](const std::string& asset) { return asset.starts_with("models/cup"); });
  EXPECT_THAT(told(input, "licences", CheckLevel::note),
              ElementsAre("warning: 4/10 models and scenes have no licence beside them: "
                          "models/cup-0.ply; models/cup-1.ply; models/cup-2.ply",
                          HasSubstr("note: 4/10 models and scenes have a licence text that is none "
                                    "of those known by name (SPDX): models/mug-0.ply")));
}

// Of many shapes, in clusters and at the edges of what is near, those pairs that comparing all with all finds.
TEST(NearPairs, AreThoseOfAllWithAll) {
  std::mt19937 random(7);
  CheckInput input;
  std::vector<std::pair<std::string, std::array<int, 19>>> models;
  for (int i = 0; i < 600; ++i) {
    std::array<int, 19> numbers{};
    for (std::size_t n = 0; n < numbers.size(); ++n)
      numbers.at(n) = static_cast<int>(random() % 3 * 301 + random() % 2);
    // A third is another with each number up to 310 steps beside it, 300 being near.
    if (i % 3 == 2)
      for (std::size_t n = 0; n < numbers.size(); ++n)
        numbers.at(n) = models.back().second.at(n) + static_cast<int>(random() % 305);
    ImageRecord image;
    image.model = fmt::format("m{:03}.ply", i);
    image.id = image.model + "/0";
    image.parts[0] = hash_text(image.id);
    image.pose = ModelPose{{}, {{0, 0, 0}, {1, 2, 3.0 + i}}};
    std::string text;
    for (const int number : numbers)
      text += fmt::format("{:04x}", number);
    input.dataset.shapes[image.model] = text;
    input.images.push_back(image);
    models.emplace_back(image.model, numbers);
  }
  std::set<std::pair<std::string, std::string>> right, found;
  for (std::size_t i = 0; i < models.size(); ++i)
    for (std::size_t j = i + 1; j < models.size(); ++j) {
      int most = 0;
      for (std::size_t n = 0; n < 19; ++n)
        most = std::max(most, std::abs(models[i].second.at(n) - models[j].second.at(n)));
      if (most <= 300) right.emplace(models[i].first, models[j].first);
    }
  for (const auto& [a, b] : near_pairs(input, Meshes(input.images, input.dataset.shapes)))
    EXPECT_TRUE(found.emplace(std::min(a->model, b->model), std::max(a->model, b->model)).second);
  EXPECT_GT(right.size(), 50U);
  EXPECT_EQ(found, right);
}

}  // namespace
}  // namespace ds
