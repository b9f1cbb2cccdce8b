// SPDX-License-Identifier: Apache-2.0
// Each fault is planted in a dataset that has none.
#include "manifests/check/check.h"

#include "tracer/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace ds {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// 4 classes of 6 models, half for training, 2 views each; materials and environments go round.
CheckInput clean() {
  CheckInput input;
  input.dataset.licence = "CC0-1.0";
  input.dataset.licences = {{"CC0-1.0", "text", {"environments/e0", "environments/e1"}}};
  std::vector<std::string>& licensed = input.dataset.licences[0].assets;
  for (const char* material : {"m0", "m1", "m2"})
    licensed.push_back(fmt::format("materials/{}.mat", material));
  std::uint64_t number = 0;
  for (const char* name : {"car", "chair", "mug", "ship"})
    for (int model = 0; model < 6; ++model)
      for (int view = 0; view < 2; ++view) {
        ImageRecord image;
        image.model = fmt::format("{}{}.ply", name, model);
        licensed.push_back("models/" + image.model);
        image.id = fmt::format("{}/{}", image.model, view);
        image.class_path = name;
        image.split = model < 3 ? "train" : "test";
        image.material = fmt::format("m{}", model % 3);
        image.environment = fmt::format("e{}", model % 2);
        image.view = std::to_string(view);
        image.width = image.height = 10;
        image.files.push_back({image.id + ".png", "image", {}, Hash128{1, ++number}});
        image.pixel_counts = {100, 0, 40, 0, 40};
        image.relative_error = 0.02;
        image.parts[0] = hash_text(image.model);
        input.images.push_back(std::move(image));
      }
  return input;
}

ImageRecord& image_of(CheckInput& input, const std::string& id) {
  return *std::find_if(input.images.begin(), input.images.end(),
                       [&](const ImageRecord& image) { return image.id == id; });
}

/// "error: 1 of 48 ...: examples" of what is above a note.
std::vector<std::string> found(const CheckInput& input, const std::string& check) {
  std::vector<std::string> lines;
  for (const CheckFinding& finding : run_checks(input, {check}))
    if (finding.level != CheckLevel::note)
      lines.push_back(fmt::format("{}: {}/{} {}: {}", name_of(finding.level), finding.count,
                                  finding.of, finding.what, fmt::join(finding.examples, ",")));
  return lines;
}

TEST(Checks, ACleanDatasetHasNothingAboveANote) {
  for (const CheckFinding& finding : run_checks(clean(), {}))
    EXPECT_EQ(finding.level, CheckLevel::note) << finding.check << ": " << finding.what;
  EXPECT_THROW(run_checks(clean(), {"leak"}), Error);
}

TEST(Checks, ADatasetOfNothing) {
  EXPECT_THAT(found(CheckInput{}, "balance"), ElementsAre(HasSubstr("the dataset has no images")));
  run_checks(CheckInput{}, {});
}

TEST(Checks, AModelThatIsADistractorOfAnotherSplit) {
  CheckInput input = clean();
  for (ImageRecord& image : input.images)
    image.pose = ModelPose{{}, {{0, 0, 0}, {1, 2, static_cast<double>(image.model.size())}}};
  const auto beside = [](const char* model, double height) {
    ObjectRecord object;
    object.model = model;
    object.pose.model_box = {{0, 0, 0}, {1, 2, height}};
    object.pixels = ObjectCounts{101, 5, 6, 0, 0, 0, 0, 0};
    return object;
  };
  image_of(input, "car0.ply/0").objects = {beside("mug1.ply", 8), beside("mug4.ply", 9)};
  EXPECT_THAT(found(input, "leaks"), IsEmpty()) << "another mesh of that name is no leak";
  image_of(input, "car0.ply/1").objects = {beside("mug4.ply", 8)};
  EXPECT_THAT(found(input, "leaks"),
              ElementsAre("error: 1/2 images show a model of another split as a distractor: "
                          "car0.ply/1"));
  image_of(input, "car0.ply/0").objects[0].pixels->seen = 0;
  bool said = false;
  for (const CheckFinding& finding : run_checks(input, {"masks"}))
    said = said || (finding.count == 1 && finding.of == 3 &&
                    finding.what == "distractors are out of their picture or wholly hidden");
  EXPECT_TRUE(said);
}

TEST(Checks, OneMeshInTwoSplits) {
  CheckInput input = clean();
  for (const char* view : {"0", "1"})
    image_of(input, std::string("mug5.ply/") + view).parts[0] = hash_text("mug0.ply");
  EXPECT_THAT(found(input, "leaks"),
              ElementsAre("error: 1/23 models are the same mesh in two splits: mug5.ply (test), "
                          "mug0.ply (train)"));
  // Within one split it is no leak.
  for (ImageRecord& image : input.images)
    if (image.model == "mug5.ply") image.split = "train";
  EXPECT_THAT(found(input, "leaks"), IsEmpty());
}

TEST(Checks, OneMeshInTwoClasses) {
  CheckInput input = clean();
  for (const char* view : {"0", "1"})
    image_of(input, std::string("ship1.ply/") + view).parts[0] = hash_text("mug0.ply");
  const std::string wanted =
      "error: 1/23 models are the same mesh in two classes: mug0.ply (mug), ship1.ply (ship)";
  EXPECT_THAT(found(input, "labels"), ElementsAre(wanted));  // both in train
  EXPECT_THAT(found(input, "leaks"), IsEmpty());
  for (ImageRecord& image : input.images)
    if (image.model == "ship1.ply") image.split = "test";
  EXPECT_THAT(found(input, "labels"), ElementsAre(wanted));
  EXPECT_EQ(run_checks(input, {"labels"}).at(0).images.size(), 4U);
  // A model that no class file lists says nothing of another.
  for (ImageRecord& image : input.images)
    if (image.model == "ship1.ply") image.class_path.clear();
  EXPECT_THAT(found(input, "labels"), IsEmpty());
}

TEST(Checks, PicturesOfEqualPixels) {
  CheckInput input = clean();
  image_of(input, "mug1.ply/1").files[0].pixels = image_of(input, "mug1.ply/0").files[0].pixels;
  EXPECT_THAT(
      found(input, "duplicates"),
      ElementsAre("warning: 1/48 pictures have the pixels of another: mug1.ply/1 as mug1.ply/0"));
  image_of(input, "car5.ply/1").files[0].pixels = image_of(input, "car0.ply/0").files[0].pixels;
  EXPECT_THAT(found(input, "duplicates"), Contains(HasSubstr("error: 1/48")));
}

TEST(Checks, FindingsNameTheirImages) {
  const auto images = [](const CheckInput& input, const char* check) {
    std::vector<std::vector<std::string>> all;
    for (const CheckFinding& finding : run_checks(input, {check}))
      if (finding.level != CheckLevel::note) all.push_back(finding.images);
    return all;
  };
  CheckInput input = clean();
  image_of(input, "mug1.ply/1").files[0].pixels = image_of(input, "mug1.ply/0").files[0].pixels;
  EXPECT_THAT(images(input, "duplicates"), ElementsAre(ElementsAre("mug1.ply/0", "mug1.ply/1")));
  image_of(input, "car5.ply/1").relative_error = 0.9;
  EXPECT_THAT(images(input, "errors"), ElementsAre(ElementsAre("car5.ply/1")));
  for (const char* view : {"0", "1"})
    image_of(input, std::string("mug5.ply/") + view).parts[0] = hash_text("mug0.ply");
  EXPECT_THAT(images(input, "leaks"),
              ElementsAre(ElementsAre("mug0.ply/0", "mug0.ply/1", "mug5.ply/0", "mug5.ply/1")));
  input.dataset.licences.clear();
  for (const auto& none : images(input, "licences"))
    EXPECT_THAT(none, IsEmpty()) << "licences are of no image";
  std::erase_if(input.images, [](const ImageRecord& image) {
    return image.class_path == "ship" && image.model != "ship0.ply";
  });
  EXPECT_THAT(images(input, "balance"), Contains(ElementsAre("ship0.ply/0", "ship0.ply/1")));
}

TEST(Checks, MaterialsThatTellTheClass) {
  CheckInput input = clean();
  for (ImageRecord& image : input.images)
    image.material = image.class_path;
  const auto lines = found(input, "shortcuts");
  ASSERT_EQ(lines.size(), 1u);
  // Four classes of equal size, told for sure: two bits.
  EXPECT_THAT(lines[0], HasSubstr("the material tells 2.00 bits of the class"));
  // Dealt out model by model: 24 models of 24 materials say nothing, though each is of one class.
  for (ImageRecord& image : input.images)
    image.material = image.model;
  EXPECT_THAT(found(input, "shortcuts"), IsEmpty());
}

TEST(Checks, ClassesOfOneSplitOrOneModelOrFarLarger) {
  CheckInput input = clean();
  for (ImageRecord& image : input.images)
    if (image.class_path == "ship") image.split = "train";
  EXPECT_THAT(found(input, "balance"),
              ElementsAre("error: 1/4 classes have images in one split only: ship (train)"));
  input = clean();
  std::erase_if(input.images, [](const ImageRecord& image) {
    return image.class_path == "ship" && image.model != "ship0.ply";
  });
  EXPECT_THAT(found(input, "balance"),
              Contains(HasSubstr("warning: 1/4 classes have a single model")));
  for (int i = 0; i < 101; ++i) {
    input.images.push_back(image_of(input, "car0.ply/0"));
    input.images.back().id += std::to_string(i);
  }
  EXPECT_THAT(found(input, "balance"), Contains(HasSubstr("ship has 2 images and car has 113")));
}

TEST(Checks, MasksAndPicturesOfNoUse) {
  CheckInput input = clean();
  image_of(input, "car0.ply/0").pixel_counts.model = 0;
  image_of(input, "car0.ply/1").pixel_counts.model = 95;
  EXPECT_THAT(found(input, "masks"),
              ElementsAre("error: 1/48 images show nothing of their model: car0.ply/0",
                          "warning: 1/48 images show nearly nothing but their model, on over 90 %: "
                          "car0.ply/1"));
  image_of(input, "car0.ply/0").pixel_counts.lit = 0;
  image_of(input, "car0.ply/1").pixel_counts.white = 26;
  EXPECT_THAT(found(input, "exposure"),
              ElementsAre(HasSubstr("error: 1/48 pictures are black"),
                          HasSubstr("warning: 1/48 pictures are clipped")));
}

TEST(Checks, ModelsCutOff) {
  CheckInput input = clean();
  const auto cut = [&](const char* id, std::uint64_t beyond, std::uint64_t whole) {
    image_of(input, id).pixel_counts.beyond = beyond;
    image_of(input, id).pixel_counts.whole = whole;
  };
  cut("car0.ply/0", 0, 10);
  cut("car0.ply/1", 5, 10);
  EXPECT_THAT(found(input, "truncation"), IsEmpty());
  const std::vector<CheckFinding> findings = run_checks(input, {"truncation"});
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].level, CheckLevel::note);
  EXPECT_THAT(findings[0].examples, ElementsAre("car0.ply/1"));
  cut("car0.ply/1", 6, 10);
  cut("car1.ply/0", 0, 0);  // some of it beside the camera
  EXPECT_THAT(
      found(input, "truncation"),
      ElementsAre("warning: 2/3 images cut off over 50 % of their model: car0.ply/1,car1.ply/0"));
}

TEST(Checks, ModelsAreInBothSplitsWhereViewsAreSplit) {
  CheckInput input = clean();
  for (ImageRecord& image : input.images)
    image.split = image.view == "0" ? "train" : "test";
  EXPECT_THAT(found(input, "leaks"),
              ElementsAre(HasSubstr("models are the same mesh in two splits")));
  input.dataset.recipe_text = "classes.split.by = \"view\"\n";
  EXPECT_THAT(found(input, "leaks"), IsEmpty());
  EXPECT_EQ(run_checks(input, {"leaks"}).front().what,
            "24 of 24 models are in more than one split");
}

TEST(Checks, ClassesAreOfOneSplitWhereClassesAreSplit) {
  CheckInput input = clean();
  for (ImageRecord& image : input.images)
    image.split = image.class_path == "car" ? "val" : image.class_path == "mug" ? "test" : "train";
  EXPECT_THAT(found(input, "balance"),
              ElementsAre(HasSubstr("classes have images in one split only")));
  input.dataset.recipe_text = "classes.split.by = \"class\"\n";
  EXPECT_THAT(found(input, "balance"), IsEmpty());
  // Whole models are split: one mesh in two splits is as bad as ever.
  for (const char* view : {"0", "1"})
    image_of(input, std::string("car1.ply/") + view).parts[0] = hash_text("mug0.ply");
  EXPECT_THAT(found(input, "leaks"),
              ElementsAre("error: 1/23 models are the same mesh in two splits: mug0.ply (test), "
                          "car1.ply (val)"));
}

TEST(Checks, ModelsThatAreSkippedAreANote) {
  CheckInput input = clean();
  input.dataset.concerns = {{"models_unlisted", 5, 29, {"a.off", "b.off", "c.off"}}};
  EXPECT_TRUE(run_checks(input, {"unused"}).empty()) << "built without a class";
  input.dataset.recipe_text = "classes.unlisted = \"skip\"\n";
  const std::vector<CheckFinding> findings = run_checks(input, {"unused"});
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].level, CheckLevel::note);
  EXPECT_EQ(findings[0].what,
            "5 of 29 model files stand in no class file and are left out (classes.unlisted = "
            "\"skip\"): a.off, b.off, c.off and 2 more");
}

TEST(Checks, CopiesOfOneShapeInTwoSplits) {
  CheckInput input = clean();
  const std::string shape = std::string(72, '1');
  input.dataset.shapes = {{"car0.ply", shape + "1000"},
                          {"car1.ply", shape + "1100"},  // in the same split
                          {"car3.ply", shape + "112c"},  // 0.03 from the first
                          {"car4.ply", shape + "122d"},  // and 0.0557
                          {"ship5.ply", "2" + shape + "000"}};
  EXPECT_THAT(
      found(input, "leaks"),
      ElementsAre("warning: 2/6 pairs of models in two splits have nearly one shape, as turned, "
                  "scaled or remeshed copies have: car0.ply (train), car3.ply (test),car1.ply "
                  "(train), car3.ply (test)"));
  input.dataset.recipe_text = "a.b = 1\ncheck.leaks_near_shape = 0.01\n";
  EXPECT_THAT(found(input, "leaks"), ElementsAre(HasSubstr("warning: 1/6")));
  input.dataset.recipe_text = "check.leaks_near_shape = 0\n";
  EXPECT_THAT(found(input, "leaks"), IsEmpty());
}

TEST(Checks, ThresholdsAreTheRecipes) {
  CheckInput input = clean();
  const auto with = [&](const char* check, const char* line) {
    input.dataset.recipe_text = std::string("dataset.seed = 1\n") + line + "\n";
    return found(input, check);
  };
  EXPECT_THAT(with("masks", "check.masks_most = 0.39"),
              ElementsAre(HasSubstr("48/48 images show nearly")));
  EXPECT_THAT(with("masks", "check.masks_least = 0.41"), ElementsAre(HasSubstr("under 41 %")));
  EXPECT_THAT(
      with("errors", "check.errors_most = 0.019"),
      ElementsAre("warning: 48/48 pictures may have an error above 0.019: car0.ply/0,car0.ply/1,"
                  "car1.ply/0"));
  EXPECT_THAT(with("errors", "check.errors_most = 0.021"), IsEmpty());
  EXPECT_THAT(with("exposure", "check.exposure_white = 0"), IsEmpty());
  EXPECT_THAT(with("exposure", "check.exposure_lit = 1"), IsEmpty()) << "all are lit";
  EXPECT_THAT(with("masks", "check.masks_most = rubbish"), IsEmpty());
  for (const Check& check : checks())
    for (const Threshold& threshold : check.thresholds) {
      EXPECT_TRUE(threshold.name.starts_with(std::string(check.name) + "_")) << threshold.name;
      EXPECT_TRUE(threshold.range.contains(threshold.standard)) << threshold.name;
    }
}

TEST(Checks, AssetsThatNoImageShows) {
  CheckInput input = clean();
  input.dataset.recipe_text =
      "models.files = [\"car0.ply\", \"boat.ply\"]\nmaterials.files = [\"m0.mat\", "
      "\"m9.mat\"]\nenvironments.files = [\"e0\"]\n";
  EXPECT_THAT(found(input, "unused"),
              ElementsAre("warning: 1/2 models of the recipe are in no image: boat.ply"));
  EXPECT_EQ(run_checks(input, {"unused"}).size(), 2U) << "and a note of the material";
}

TEST(Checks, WhatTellsTheSplit) {
  CheckInput input = clean();
  for (ImageRecord& image : input.images)
    image.environment = image.split == "train" ? "studio" : "garden";
  EXPECT_THAT(found(input, "shortcuts"),
              ElementsAre(HasSubstr("the environment tells 1.00 bits of the split, ")));
  input.dataset.recipe_text = "classes.split.by = \"environment\"\n";
  EXPECT_THAT(found(input, "shortcuts"), IsEmpty()) << "it is meant";
}

TEST(Checks, NoiseAndLostSamples) {
  CheckInput input = clean();
  image_of(input, "car0.ply/0").relative_error = 0.061;
  image_of(input, "car0.ply/1").rejected_samples = 1;
  image_of(input, "car1.ply/0").film.capped = true;
  EXPECT_THAT(
      found(input, "errors"),
      ElementsAre(HasSubstr("warning: 1/48 pictures are more than 3 times as noisy as the median "
                            "(0.02): car0.ply/0"),
                  HasSubstr("did not reach the error that was wanted: car1.ply/0"),
                  HasSubstr("lost samples that were NaN, infinite or negative: car0.ply/1")));
}

TEST(Checks, NoiseIsBoundedAlreadyWhereTheRecipeSaysSo) {
  CheckInput input = clean();
  image_of(input, "car0.ply/0").relative_error = 0.061;
  input.dataset.recipe_text = "engine.error = 0.1\n";
  EXPECT_THAT(found(input, "errors"), IsEmpty());
  const std::vector<CheckFinding> all = run_checks(input, {"errors"});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_THAT(all[0].advice, HasSubstr("engine.error bounds"));
  input.dataset.recipe_text = "engine.error = false\n";
  EXPECT_THAT(found(input, "errors"), ElementsAre(HasSubstr("warning: 1/48 pictures are more")));
}

TEST(Checks, MissingLicences) {
  CheckInput input = clean();
  input.dataset.licence.clear();
  input.dataset.licences.clear();
  EXPECT_THAT(
      found(input, "licences"),
      ElementsAre(HasSubstr("warning: 29/29 models and scenes have no licence beside them: ")));
  // What the pictures may be used for is the maker's to say, within what the models allow.
  const std::vector<CheckFinding> all = run_checks(input, {"licences"});
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].what, "the dataset names no licence");
  for (const CheckFinding& finding : all)
    EXPECT_EQ(finding.advice.find("CC"), std::string::npos) << "no licence is proposed";
}

TEST(Checks, AssetsWithoutLicenceOrSource) {
  CheckInput input = clean();
  std::vector<std::string> assets{"environments/e0", "environments/e1", "materials/m0.mat",
                                  "materials/m1.mat", "materials/m2.mat"};
  for (const ImageRecord& image : input.images)
    assets.push_back("models/" + image.model);
  input.dataset.licences[0].assets = input.dataset.sources.emplace_back().assets = assets;
  for (const char* check : {"licences", "sources"})
    EXPECT_THAT(run_checks(input, {check}), IsEmpty()) << check;
  // One model and one material of 29 things: eight models of the material, and one of the others.
  std::erase(assets, "models/car0.ply");
  std::erase(assets, "materials/m1.mat");
  input.dataset.licences[0].assets = input.dataset.sources[0].assets = assets;
  for (const char* check : {"licences", "sources"}) {
    const std::vector<CheckFinding> all = run_checks(input, {check});
    ASSERT_EQ(all.size(), 1U) << check;
    EXPECT_EQ(all[0].level,
              std::string(check) == "licences" ? CheckLevel::warning : CheckLevel::note);
    EXPECT_EQ(all[0].count, 2U);
    EXPECT_EQ(all[0].of, 24U + 3 + 2);
    EXPECT_THAT(all[0].examples, ElementsAre("materials/m1", "models/car0.ply"));
    EXPECT_EQ(all[0].images.size(), (8U + 1) * 2);
  }
  input.dataset.sources.clear();
  EXPECT_EQ(run_checks(input, {"sources"})[0].count, 29U);
}

}  // namespace
}  // namespace ds
