// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/dataset_concerns.h"

#include "builder/plan/dataset_manifest.h"
#include "tests/builder/tiny_dataset.h"

#include <gtest/gtest.h>

#include <map>

namespace ds {
namespace {

std::map<std::string, std::uint64_t> counts(const std::vector<Concern>& concerns) {
  std::map<std::string, std::uint64_t> found;
  for (const Concern& concern : concerns)
    if (concern.count > 0) found[concern.name] = concern.count;
  return found;
}

ImageFacts image(const char* id, const PixelCounts& counts) {
  return {id, "", "", "", 100 * 100, counts};
}

const std::vector<Concern> k_physical{{"assets_unphysical", 0, 3, {}}};

using Counts = std::map<std::string, std::uint64_t>;

TEST(DatasetConcernsTest, each_image_is_judged_by_its_pixels) {
  const auto of = [](const PixelCounts& pixels) {
    return counts(dataset_concerns({}, k_physical, {image("a", pixels)}));
  };
  EXPECT_EQ(of({10000, 0, 5000, 0}), Counts{});
  EXPECT_EQ(of({10000, 0, 0, 0}), (Counts{{"mask_empty", 1}}));
  EXPECT_EQ(of({10000, 0, 99, 0}), (Counts{{"mask_small", 1}}));
  EXPECT_EQ(of({10000, 0, 100, 0}), Counts{});
  EXPECT_EQ(of({10000, 0, 99, 1}), (Counts{{"mask_small", 1}, {"mask_at_frame", 1}}));
  EXPECT_EQ(of({9, 0, 5000, 0}), (Counts{{"picture_black", 1}}));
  EXPECT_EQ(of({10, 0, 5000, 0}), Counts{});
  EXPECT_EQ(of({10000, 2500, 5000, 0}), Counts{});
  EXPECT_EQ(of({10000, 2501, 5000, 0}), (Counts{{"picture_white", 1}}));
  EXPECT_EQ(of({}), Counts{});  // neither picture nor mask
}

TEST(DatasetConcernsTest, they_are_counted_of_those_looked_at_with_a_few_names) {
  std::vector<ImageFacts> images;
  for (const char* id : {"a", "b", "c", "d", "e"})
    images.push_back(image(id, {{}, {}, 0, 0}));
  images.push_back(image("no-mask", {10000, 0, {}, {}}));
  std::vector<Concern> concerns = dataset_concerns({}, k_physical, images);
  EXPECT_EQ(concern(concerns, "mask_empty"), (Concern{"mask_empty", 5, 5, {"a", "b", "c"}}));
  EXPECT_EQ(concern(concerns, "picture_black"), (Concern{"picture_black", 0, 1, {}}));
}

TEST(DatasetConcernsTest, a_class_has_the_images_of_those_below_it) {
  Recipe recipe;
  recipe.class_paths = {"animal", "vehicle", "vehicle/car", "vehicle/car/van", "vehicle/plane"};
  std::vector<ImageFacts> images{image("a", {})};
  images[0].class_path = "vehicle/car/van";
  std::vector<Concern> concerns = dataset_concerns(recipe, k_physical, images);
  EXPECT_EQ(concern(concerns, "classes_empty"),
            (Concern{"classes_empty", 2, 5, {"animal", "vehicle/plane"}}));
}

TEST(DatasetConcernsTest, what_is_to_come_is_not_missed) {
  Recipe recipe;
  recipe.class_paths = {"animal", "vehicle", "vehicle/car"};
  recipe.split.test = 0.05;
  std::vector<ImageFacts> images{image("a", {})};
  images[0].class_path = "animal";
  images[0].split = "train";
  ImageSpec to_come;
  to_come.class_path = std::string("vehicle/car");
  to_come.split = std::string("test");
  EXPECT_EQ(counts(dataset_concerns(recipe, k_physical, images)),
            (Counts{{"classes_empty", 2}, {"splits_empty", 1}}));
  EXPECT_EQ(counts(dataset_concerns(recipe, k_physical, images, {&to_come})), Counts{});
}

TEST(DatasetConcernsTest, a_split_that_is_asked_for_has_images) {
  std::vector<ImageFacts> images{image("a", {})};
  images[0].split = "train";
  Recipe recipe;
  const auto splits = [&] {
    std::vector<Concern> concerns = dataset_concerns(recipe, k_physical, images);
    return concern(concerns, "splits_empty");
  };
  EXPECT_EQ(splits(), (Concern{"splits_empty", 0, 0, {}}));
  recipe.split.test = 0.05;
  EXPECT_EQ(splits(), (Concern{"splits_empty", 1, 2, {"test"}}));
  recipe.split.test.reset();
  recipe.train_classes = "train.cla";
  EXPECT_EQ(splits(), (Concern{"splits_empty", 0, 1, {}}));
}

class ConcernsBuildTest : public TinyDataset {};

TEST_F(ConcernsBuildTest, ABuildThatReusesEverythingStillReports) {
  // The fake's masks are noise: each touches the frame.
  const BuildResult first = build();
  EXPECT_EQ(counts(first.concerns), (Counts{{"mask_at_frame", k_images}}));
  const BuildResult second = build();
  EXPECT_EQ(second.reused, k_images);
  EXPECT_EQ(second.concerns, first.concerns);
  EXPECT_EQ(read_dataset_manifest(output()).concerns, first.concerns);
}

TEST_F(ConcernsBuildTest, WhatAnOlderDsbuildMadeIsCountedOnce) {
  const BuildResult first = build();
  {
    Dataset dataset = open_dataset(request, Access::build, real_disk);
    dataset.database->connection().execute("UPDATE product SET facts = ''");
  }
  // That one's lines had no counts either.
  std::filesystem::remove(output() / "manifest/images.jsonl");
  // Whether a white pixel was clipped, the picture alone does not tell.
  std::vector<Concern> known = first.concerns;
  concern(known, "picture_white").of = 0;
  EXPECT_EQ(build().concerns, known);
  const Plan all = plan();
  Dataset dataset = open_dataset(request, Access::look, real_disk);
  for (const PlannedImage& image : all.images)
    for (const OutputFile& output : image.keys.outputs) {
      const PixelCounts counts = dataset.database->find_product(output.key)->pixel_counts;
      EXPECT_EQ(counts.lit.has_value(), output.kind == "image");
      EXPECT_EQ(counts.model.has_value(), output.kind == "mask");
    }
}

TEST_F(ConcernsBuildTest, TheStoresRecordsHoldTheCountsToo) {
  build();
  const auto wanted = contents();
  std::filesystem::remove(output() / ".dsbuild/dsbuild.sqlite");
  build();
  EXPECT_EQ(contents(), wanted);
}

}  // namespace
}  // namespace ds
