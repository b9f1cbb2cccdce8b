// SPDX-License-Identifier: Apache-2.0
#include "manifests/diff/datasets.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

namespace ds {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<ImageRecord> images_of(const std::vector<std::string>& ids) {
  std::vector<ImageRecord> images;
  for (const std::string& id : ids) {
    ImageRecord image;
    image.id = image.model = id;
    image.intrinsics.emplace();
    image.files = {{id + ".png", "image", {}, {}}, {id + ".mask.png", "mask", {}, {}}};
    image.files[0].hashes.xxh128 = hash_text(id);
    images.push_back(std::move(image));
  }
  return images;
}

/// Of manifests as they are written.
DatasetDifference compare(const DatasetRecord& a, const std::vector<ImageRecord>& images_a,
                          const DatasetRecord& b, const std::vector<ImageRecord>& images_b) {
  const TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path();
  write_manifest(folder / "a", a, images_a);
  write_manifest(folder / "b", b, images_b);
  return compare_datasets(folder / "a", folder / "b");
}

DatasetDifference compare(const std::vector<ImageRecord>& a, const std::vector<ImageRecord>& b) {
  return compare({}, a, {}, b);
}

TEST(CompareDatasets, FindsWhatIsInOneAlone) {
  const auto a = images_of({"a", "b", "d", "e"}), b = images_of({"b", "c", "e", "f"});
  const DatasetDifference found = compare(a, b);
  EXPECT_THAT(found.only_a, ElementsAre("a", "d"));
  EXPECT_THAT(found.only_b, ElementsAre("c", "f"));
  EXPECT_EQ(found.same, 2u);
  EXPECT_THAT(found.changed, IsEmpty());
  EXPECT_TRUE(found.images_differ());
  EXPECT_FALSE(compare(a, a).images_differ());
  EXPECT_THAT(compare(a, {}).only_a, ElementsAre("a", "b", "d", "e"));
}

/// Lines that are the same are not taken apart, and one that is no line of a manifest is told all the same.
TEST(CompareDatasets, TellsWhatIsNoManifest) {
  const TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path();
  const auto images = images_of({"a", "b \"quoted\"", "c"});
  for (const char* name : {"a", "b"})
    write_manifest(folder / name, {}, images);
  EXPECT_EQ(compare_datasets(folder / "a", folder / "b").same, 3u);
  const std::string text = read_text_file(folder / "a/manifest/images.jsonl");
  const std::size_t second = text.find('\n') + 1;
  for (const auto& [wrong, told] : std::vector<std::pair<std::string, std::string>>{
           {text.substr(0, text.size() - 1), ":3: must end in a line break"},
           {text + text.substr(0, second), ":4: ids must ascend, found a behind c"},
           {text.substr(0, second) + text, ":2: ids must ascend, found a behind a"},
           {text.substr(0, second) + "{}\n" + text.substr(second), ":2: "}}) {
    for (const char* name : {"a", "b"})
      write_file_atomic(folder / (std::string(name) + "/manifest/images.jsonl"), wrong);
    try {
      compare_datasets(folder / "a", folder / "b");
      ADD_FAILURE() << told;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("images.jsonl" + told));
    }
  }
  EXPECT_THROW(compare_datasets(folder / "a", folder / "nowhere"), Error);
}

TEST(CompareDatasets, NamesPartsFieldsAndFiles) {
  const auto a = images_of({"a", "b", "c"});
  auto b = a;
  b[0].parts[1] = b[0].parts[4] = Hash128{1, 2};
  b[0].render_key = Hash128{3, 4};
  b[0].files[0].hashes.xxh128 = b[0].files[0].pixels = Hash128{5, 6};
  b[1].split = "test";
  b[2].files[1].hashes.xxh128 = Hash128{7, 8};
  b[2].files.push_back({"c.depth.exr", "depth", {}, {}});
  const DatasetDifference found = compare(a, b);
  ASSERT_EQ(found.changed.size(), 3u);
  EXPECT_THAT(found.changed[0].parts, ElementsAre("material"));
  EXPECT_THAT(found.changed[0].fields, IsEmpty());
  ASSERT_EQ(found.changed[0].files.size(), 1u);
  EXPECT_EQ(found.changed[0].files[0].either().kind, "image");
  EXPECT_FALSE(found.changed[0].files[0].is_same_picture());
  EXPECT_THAT(found.changed[1].fields, ElementsAre("split"));
  EXPECT_THAT(found.changed[1].files, IsEmpty());
  EXPECT_THAT(found.changed[2].parts, IsEmpty());
  ASSERT_EQ(found.changed[2].files.size(), 2u);
  EXPECT_FALSE(found.changed[2].files[0].a);
  EXPECT_TRUE(found.changed[2].files[1].is_same_picture());
}

/// Parts named of one image, where these of its key differ.
std::vector<std::string> parts_named(const std::vector<std::size_t>& differing,
                                     const DatasetRecord& a, const DatasetRecord& b,
                                     const std::function<void(ImageRecord&)>& change = {}) {
  auto images = images_of({"x"});
  images[0].pose = ModelPose{};
  auto others = images;
  for (const std::size_t part : differing)
    others[0].parts[part] = Hash128{1, 2};
  if (change) change(others[0]);
  return compare(a, images, b, others).changed.at(0).parts;
}

DatasetRecord dataset_of(const std::string& recipe_text) {
  DatasetRecord record;
  record.recipe_text = recipe_text;
  record.shapes = {{"x", "0123"}};
  return record;
}

TEST(CompareDatasets, NamesTheEngineWhereMoreOfItDiffersThanTheProgram) {
  const std::string settings = "engine.depth_total = 6\nengine.keep_sums = false\nengine.spp = 4\n";
  const DatasetRecord a = dataset_of(settings);
  // The program follows from material, environment and lens.
  for (const std::size_t part : {1U, 2U, 3U})
    EXPECT_EQ(parts_named({part, 4}, a, a).size(), 1u) << part;
  EXPECT_THAT(
      parts_named({1, 4}, a,
                  dataset_of("engine.depth_total = 6\nengine.keep_sums = true\nengine.spp = 4\n")),
      ElementsAre("material"));
  // Not from the model, and by itself it is another dsbuild's.
  EXPECT_THAT(parts_named({0, 4}, a, a), ElementsAre("model", "engine"));
  EXPECT_THAT(parts_named({4}, a, a), ElementsAre("engine"));
  DatasetRecord newer = a;
  newer.dsbuild_version = "2";
  EXPECT_THAT(parts_named({1, 4}, a, newer), ElementsAre("material", "engine"));
  // A setting, of the recipe or of the image.
  EXPECT_THAT(parts_named({1, 4}, a, dataset_of("engine.depth_total = 7\nengine.spp = 4\n")),
              ElementsAre("material", "engine"));
  for (const auto& change : std::vector<std::function<void(ImageRecord&)>>{
           [](ImageRecord& image) { image.seed = 1; }, [](ImageRecord& image) { image.spp = 1; },
           [](ImageRecord& image) { image.width = 1; },
           [](ImageRecord& image) { image.height = 1; },
           [](ImageRecord& image) { image.math = "fast"; }})
    EXPECT_THAT(parts_named({1, 4}, a, a, change), ElementsAre("material", "engine"));
  // With an error to be reached, each image's samples follow, and the tone map says where they go.
  const std::string target = "engine.error = 0.02\nengine.max_spp = 64\n";
  EXPECT_THAT(parts_named({1, 4}, dataset_of(target), dataset_of(target),
                          [](ImageRecord& image) { image.spp = 7; }),
              ElementsAre("material"));
  EXPECT_THAT(parts_named({1, 4}, dataset_of(target),
                          dataset_of(target + "outputs.tone_map = \"linear\"\n")),
              ElementsAre("material", "engine"));
  EXPECT_THAT(parts_named({1, 4}, a, dataset_of(settings + "outputs.tone_map = \"linear\"\n")),
              ElementsAre("material"));
}

TEST(CompareDatasets, NamesTheModelWhereMoreOfItDiffersThanWhatTheMaterialReads) {
  const DatasetRecord a = dataset_of("models.normals = \"smooth\"\n");
  EXPECT_THAT(parts_named({0, 1, 4}, a, a), ElementsAre("material"));
  EXPECT_THAT(parts_named({0}, a, a), ElementsAre("model"));
  EXPECT_THAT(parts_named({0, 2}, a, a), ElementsAre("model", "environment"));
  EXPECT_THAT(parts_named({0, 1}, a, dataset_of("models.normals = \"flat\"\n")),
              ElementsAre("model", "material"));
  DatasetRecord other = a;
  other.shapes = {{"x", "4567"}};
  EXPECT_THAT(parts_named({0, 1}, a, other), ElementsAre("model", "material"));
  other.shapes.clear();
  EXPECT_THAT(parts_named({0, 1}, a, other), ElementsAre("model", "material"));
  for (const auto& change : std::vector<std::function<void(ImageRecord&)>>{
           [](ImageRecord& image) { image.pose->model_to_world[3] = 1; },
           [](ImageRecord& image) { image.pose.reset(); }})
    EXPECT_THAT(parts_named({0, 1}, a, a, change), ElementsAre("model", "material"));
}

TEST(CompareDatasets, NamesWhatDiffersInTheDatasetsRecord) {
  DatasetRecord a, b;
  b.licence = "CC0-1.0";
  b.counts = {{"images", 3}};
  EXPECT_THAT(compare(a, {}, b, {}).dataset_fields, ElementsAre("licence"));
}

}  // namespace
}  // namespace ds
