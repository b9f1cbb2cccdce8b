// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/plan.h"

#include "tests/builder/tiny_dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

namespace ds {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class PlanTest : public TinyDataset {
 protected:
  /// The reasons of all stale images that name `text`.
  std::size_t reasons_with(const std::string& text) {
    std::size_t count = 0;
    for (const PlannedImage& image : plan().images)
      for (const std::string& reason : image.reasons)
        count += reason.find(text) != std::string::npos ? 1U : 0U;
    return count;
  }
};

TEST_F(PlanTest, LookingAtADatasetNeverBuiltMakesNothing) {
  const Plan all = plan();
  EXPECT_EQ(all.images.size(), k_images);
  for (const PlannedImage& image : all.images)
    EXPECT_THAT(image.reasons, ElementsAre("new"));
  EXPECT_FALSE(std::filesystem::exists(output()));
}

TEST_F(PlanTest, NothingIsStaleAfterABuild) {
  build();
  EXPECT_THAT(stale(), IsEmpty());
}

TEST_F(PlanTest, WhatCannotChangeAPixelMakesNothingStale) {
  build();
  edit("materials/red.mat", "# A matte red.", "# Another comment.\n\n");
  edit("materials/green.mat", "kd = 0.1 0.6 0.1", "kd =   0.10  0.6 0.1");
  edit("recipe.toml", "name = \"tiny\"", "name = \"renamed\"");
  edit("models/box.off", "# a box, longer than wide\n", "");
  edit("models/tetra.ply", "comment a tetrahedron", "comment saved again by another program");
  const auto now = std::filesystem::file_time_type::clock::now();
  for (const char* file :
       {"models/box.off", "environments/floor/floor.ply", "environments/plain/environment.scn"})
    std::filesystem::last_write_time(recipe_folder() / file, now);
  EXPECT_THAT(stale(), IsEmpty());
}

TEST_F(PlanTest, AnEditOfAMaterialMakesItsImagesStaleAndSaysWhy) {
  build();
  edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.75 0.1 0.1");
  const Plan all = plan();
  for (const PlannedImage& image : all.images) {
    EXPECT_EQ(image.stale(), image.spec.material_name == "red") << image.spec.id;
    EXPECT_EQ(image.trace_film, image.stale());
    EXPECT_FALSE(image.trace_planes) << "a colour moves no mask";
    if (image.stale()) {
      EXPECT_THAT(image.reasons,
                  ElementsAre(testing::AllOf(HasSubstr("material changed: "), HasSubstr("kd"),
                                             HasSubstr("0.7 0.1 0.1 -> 0.75 0.1 0.1"))));
    }
  }
}

TEST_F(PlanTest, AMovedMeshOfAnEnvironmentMovesItsMasks) {
  build();
  edit("environments/floor/floor.ply", "-1 -1 -0.0574", "-1 -1 -0.05");
  for (const PlannedImage& image : plan().images) {
    EXPECT_EQ(image.trace_planes, image.spec.environment_name == "floor");
    EXPECT_EQ(image.trace_film, image.spec.environment_name == "floor");
  }
}

/// Kinds of the files that are to be made.
std::set<std::string> kinds_to_make(const Plan& plan) {
  std::set<std::string> kinds;
  for (const PlannedImage& image : plan.images)
    for (const PlannedFile& file : image.files)
      if (file.state == FileState::to_make) kinds.insert(file.output.kind);
  return kinds;
}

TEST_F(PlanTest, APlaneOfLightGoesStaleWithItsPictureAndColoursWithMaterialsAlone) {
  const std::string planes = R"(outputs.planes=["uv", "albedo", "emission", "direct_diffuse"])";
  request.overrides = {planes};
  build();
  EXPECT_THAT(kinds_to_make(plan()), IsEmpty());
  request.overrides = {planes, "engine.spp=2"};
  EXPECT_THAT(kinds_to_make(plan()), ElementsAre("direct_diffuse", "emission", "image"));
  request.overrides = {planes, "outputs.tone_map=linear"};
  EXPECT_THAT(kinds_to_make(plan()), ElementsAre("image"));
  request.overrides = {R"(outputs.planes=["albedo", "emission", "indirect_glossy"])"};
  EXPECT_THAT(kinds_to_make(plan()), ElementsAre("indirect_glossy"));
  request.overrides = {planes};
  edit("environments/floor/environment.scn", "sky.color = 1.0", "sky.color = 0.5");
  EXPECT_THAT(kinds_to_make(plan()), ElementsAre("direct_diffuse", "emission", "image"));
  edit("environments/floor/environment.scn", "floor.kd = 0.5", "floor.kd = 0.4");
  EXPECT_THAT(kinds_to_make(plan()), ElementsAre("albedo", "direct_diffuse", "emission", "image"));
  edit("environments/floor/environment.scn", "sky.color = 0.5", "sky.color = 1.0");
  edit("environments/floor/environment.scn", "floor.kd = 0.4", "floor.kd = 0.5");
  EXPECT_THAT(kinds_to_make(plan()), IsEmpty());
  edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.75 0.1 0.1");
  EXPECT_THAT(kinds_to_make(plan()), ElementsAre("albedo", "direct_diffuse", "emission", "image"));
  for (const PlannedImage& image : plan().images)
    EXPECT_EQ(image.trace_light, image.stale()) << image.spec.id;
}

TEST_F(PlanTest, MissingAndChangedFilesAreSeen) {
  build();
  std::filesystem::remove(output() / "images/box.off/1.png");
  std::filesystem::remove(output() / "images/tetra.ply/2.mask.png");
  write_file_atomic(output() / "images/tetra.ply/2.mask.png", std::string_view("no mask"));
  const Plan all = plan();
  std::size_t seen = 0;
  for (const PlannedImage& image : all.images) {
    seen += image.stale() ? 1U : 0U;
    EXPECT_FALSE(image.trace_film || image.trace_planes);
    if (image.spec.id == "box.off/1") {
      EXPECT_THAT(image.reasons, ElementsAre("images/box.off/1.png is missing"));
    }
    if (image.spec.id == "tetra.ply/2") {
      EXPECT_THAT(image.reasons,
                  ElementsAre("images/tetra.ply/2.mask.png was changed on the disk"));
    }
  }
  EXPECT_EQ(seen, 2U);
}

TEST_F(PlanTest, ARewrittenFileOfTheSameBytesIsTheSameFile) {
  build();
  const auto file = output() / "images/box.off/1.png";
  const std::string bytes = read_text_file(file);
  std::filesystem::remove(file);
  write_file_atomic(file, bytes);
  EXPECT_THAT(stale(), IsEmpty());
}

TEST_F(PlanTest, ALostFilmCountsOnlyWhenItIsNeeded) {
  build();
  std::filesystem::remove_all(output() / ".dsbuild/objects");
  EXPECT_THAT(stale(), IsEmpty());
  std::filesystem::remove(output() / "images/box.off/1.png");
  EXPECT_EQ(reasons_with("its film is not in the store"), 1U);
}

TEST_F(PlanTest, AModelThatCannotBeReadFailsItsImagesOnly) {
  write_file_atomic(recipe_folder() / "models/bad.ply",
                    std::string_view("ply\nformat ascii 1.0\n"));
  const Plan all = plan();
  EXPECT_EQ(all.images.size(), k_images + 4);
  for (const PlannedImage& image : all.images)
    EXPECT_EQ(image.error.has_value(), image.spec.model_name == "bad.ply");
}

TEST_F(PlanTest, ARemovedModelsFilesAreToBeRemoved) {
  build();
  std::filesystem::remove(recipe_folder() / "models/box.off");
  const Plan all = plan();
  EXPECT_EQ(all.to_remove.size(), 8U);
  EXPECT_THAT(all.to_remove, Contains("images/box.off/3.mask.png"));
}

TEST_F(PlanTest, UnchangedModelsAreNotReadAgain) {
  build();
  // What is remembered of the box is made to be the tetrahedron: only who reads the file can tell.
  const auto box = recipe_folder() / "models/box.off";
  {
    Dataset dataset = open_dataset(request, Access::look, real_disk);
    dataset.database->put_content(box, *stamp_of(box),
                                  hash_file(recipe_folder() / "models/tetra.ply").xxh128);
  }
  EXPECT_THAT(stale(), SizeIs(4)) << "the memory is believed";
  EXPECT_THAT(stale(Stamps::ignore), IsEmpty()) << "the file is read";
}

TEST_F(PlanTest, AModelReplacedWithItsTimesKeptIsSeen) {
  const auto box = recipe_folder() / "models/box.off";
  const auto hour_ago = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
  std::filesystem::last_write_time(box, hour_ago);
  build();
  {
    Dataset dataset = open_dataset(request, Access::look, real_disk);  // as a later plan does
    dataset.database->put_content(box, *stamp_of(box), hash_file(box).xxh128);
  }
  std::string text = read_text_file(box);
  text.replace(text.find("-1 -1 -2"), 8, "-1 -1 -3");
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  std::ofstream(box, std::ios::binary) << text;  // in place, as cp -p does
  std::filesystem::last_write_time(box, hour_ago);
  EXPECT_THAT(stale(), SizeIs(4));
}

TEST_F(PlanTest, AnOutputChangedBehindItsStampIsSeenByWhoReadsIt) {
  build();
  const auto file = output() / "images/box.off/1.png";
  write_file_atomic(file, read_text_file(output() / "images/box.off/2.png"));
  {
    Dataset dataset = open_dataset(request, Access::look, real_disk);
    PlacedFile placed = dataset.database->placed_files(dataset.row.id).at("images/box.off/1.png");
    placed.stamp = stamp_of(file);
    dataset.database->put_placed(dataset.row.id, placed);
  }
  EXPECT_THAT(stale(), IsEmpty());
  EXPECT_THAT(stale(Stamps::ignore), ElementsAre("box.off/1"));
}

}  // namespace
}  // namespace ds
