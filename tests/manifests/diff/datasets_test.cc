// SPDX-License-Identifier: Apache-2.0
#include "manifests/diff/datasets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ds {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<ImageRecord> images_of(const std::vector<std::string>& ids) {
  std::vector<ImageRecord> images;
  for (const std::string& id : ids) {
    ImageRecord image;
    image.id = image.model = id;
    image.files = {{id + ".png", "image", {}, {}}, {id + ".mask.png", "mask", {}, {}}};
    image.files[0].hashes.xxh128 = hash_text(id);
    images.push_back(std::move(image));
  }
  return images;
}

DatasetDifference compare(const std::vector<ImageRecord>& a, const std::vector<ImageRecord>& b) {
  return compare_datasets({}, a, {}, b);
}

std::vector<std::string> ids(const std::vector<const ImageRecord*>& images) {
  std::vector<std::string> names;
  for (const ImageRecord* image : images)
    names.push_back(image->id);
  return names;
}

TEST(CompareDatasets, FindsWhatIsInOneAlone) {
  const auto a = images_of({"a", "b", "d", "e"}), b = images_of({"b", "c", "e", "f"});
  const DatasetDifference found = compare(a, b);
  EXPECT_THAT(ids(found.only_a), ElementsAre("a", "d"));
  EXPECT_THAT(ids(found.only_b), ElementsAre("c", "f"));
  EXPECT_EQ(found.same, 2u);
  EXPECT_THAT(found.changed, IsEmpty());
  EXPECT_TRUE(found.images_differ());
  EXPECT_FALSE(compare(a, a).images_differ());
  EXPECT_THAT(ids(compare(a, {}).only_a), ElementsAre("a", "b", "d", "e"));
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
  EXPECT_THAT(found.changed[0].parts, ElementsAre("material", "engine"));
  EXPECT_THAT(found.changed[0].fields, IsEmpty());
  ASSERT_EQ(found.changed[0].files.size(), 1u);
  EXPECT_EQ(found.changed[0].files[0].either().kind, "image");
  EXPECT_FALSE(found.changed[0].files[0].is_same_picture());
  EXPECT_THAT(found.changed[1].fields, ElementsAre("split"));
  EXPECT_THAT(found.changed[1].files, IsEmpty());
  EXPECT_THAT(found.changed[2].parts, IsEmpty());
  ASSERT_EQ(found.changed[2].files.size(), 2u);
  EXPECT_EQ(found.changed[2].files[0].a, nullptr);
  EXPECT_TRUE(found.changed[2].files[1].is_same_picture());
}

TEST(CompareDatasets, NamesWhatDiffersInTheDatasetsRecord) {
  DatasetRecord a, b;
  b.licence = "CC0-1.0";
  b.counts = {{"images", 3}};
  EXPECT_THAT(compare_datasets(a, {}, b, {}).dataset_fields, ElementsAre("licence"));
}

}  // namespace
}  // namespace ds
