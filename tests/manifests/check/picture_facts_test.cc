// SPDX-License-Identifier: Apache-2.0
// Pictures drawn by hand, whose facts can be counted on paper.
#include "manifests/check/picture_facts.h"

#include "manifests/check/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace ds {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr int k_size = 64;

DecodedImage flat(int value, int channels = 3) {
  DecodedImage image;
  image.width = image.height = k_size;
  image.channels = channels;
  image.samples.assign(static_cast<std::size_t>(k_size * k_size * channels),
                       static_cast<std::byte>(value));
  return image;
}

void set(DecodedImage& image, int x, int y, int value) {
  for (int c = 0; c < image.channels; ++c)
    image.samples[static_cast<std::size_t>((y * k_size + x) * image.channels + c)] =
        static_cast<std::byte>(value);
}

/// Lighter to the right, with a square of that side in it.
DecodedImage scene(int side, int square) {
  DecodedImage image = flat(0);
  for (int y = 0; y < k_size; ++y)
    for (int x = 0; x < k_size; ++x)
      set(image, x, y, y < side && x < side ? square : 20 + 2 * x);
  return image;
}

std::uint64_t specks_of(const std::vector<std::pair<int, int>>& at, int value) {
  DecodedImage image = flat(100);
  for (const auto& [x, y] : at)
    set(image, x, y, value);
  const PictureFacts facts = facts_of(image, nullptr);
  EXPECT_EQ(facts.pixels, 64U * 64U);
  return facts.specks;
}

TEST(PictureFacts, SpecksAreOneOrTwoLightPixels) {
  EXPECT_EQ(specks_of({}, 0), 0U);
  EXPECT_EQ(specks_of({{20, 30}}, 139), 1U);  // 39 / 255 = 0.153
  EXPECT_EQ(specks_of({{20, 30}}, 138), 0U);  // 38 / 255 = 0.149
  EXPECT_EQ(specks_of({{20, 30}}, 0), 0U);
  EXPECT_EQ(specks_of({{20, 30}, {21, 30}}, 255), 2U);
  EXPECT_EQ(specks_of({{20, 30}, {20, 31}, {40, 40}}, 255), 3U);
  EXPECT_EQ(specks_of({{20, 30}, {21, 30}, {22, 31}}, 255), 0U);  // a highlight
  EXPECT_EQ(specks_of({{20, 30}, {23, 30}, {26, 30}}, 255), 3U);  // each alone in its 5 x 5
}

TEST(PictureFacts, ContrastIsThatOfTheEdge) {
  DecodedImage picture = flat(102), mask = flat(0, 1);
  for (int y = 10; y < 40; ++y)
    for (int x = 10; x < 40; ++x) {
      set(mask, x, y, 255);
      const bool rim = x == 10 || y == 10 || x == 39 || y == 39;
      set(picture, x, y, rim ? 115 : 128);  // as a filter blurs it
    }
  set(picture, 60, 60, 255);
  const PictureFacts facts = facts_of(picture, &mask);
  ASSERT_TRUE(facts.edge_contrast.has_value());
  // Beside the corners the row two pixels in is the rim of another side: 2 of 30 crossings of each of the
  // four sides at either end are 13 / 255.
  EXPECT_NEAR(*facts.edge_contrast, (28 * 26.0 + 2 * 13.0) / 30 / 255, 1e-6);
  EXPECT_FALSE(facts_of(picture, nullptr).edge_contrast.has_value());
  const DecodedImage nothing = flat(0, 1);
  EXPECT_FALSE(facts_of(picture, &nothing).edge_contrast.has_value());
}

TEST(PictureFacts, ThumbnailAndGradient) {
  const PictureFacts facts = facts_of(scene(0, 0), nullptr);
  // Part i holds the columns 4 i to 4 i + 3.
  for (std::size_t i = 0; i < 16; ++i)
    EXPECT_NEAR(facts.thumbnail[3 * i + 1], (20 + 2 * (4 * static_cast<double>(i) + 1.5)) / 255,
                1e-6);
  EXPECT_EQ(facts.gradient, ~std::uint64_t{0});
  EXPECT_EQ(facts_of(flat(7), nullptr).gradient, 0U);
  const PictureFacts dark = facts_of(flat(51), nullptr), light = facts_of(flat(102), nullptr);
  EXPECT_TRUE(are_alike(dark, light, 0.2 + 1e-6));
  EXPECT_FALSE(are_alike(dark, light, 0.2 - 1e-6));
}

/// Four images of one model, two in each split.
CheckInput with_pictures(const std::vector<DecodedImage>& pictures) {
  CheckInput input;
  DecodedImage mask = flat(0, 1);
  for (int y = 10; y < 40; ++y)
    for (int x = 10; x < 40; ++x)
      set(mask, x, y, 255);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    ImageRecord image;
    image.id = "mug/" + std::to_string(i);
    image.split = i < 2 ? "train" : "test";
    image.camera_to_world[3] = static_cast<double>(i);
    image.files.push_back({image.id + ".png", "image", {}, Hash128{1, i}});
    input.images.push_back(std::move(image));
    input.files.pictures.emplace_back(facts_of(pictures[i], &mask));
  }
  return input;
}

std::vector<std::string> found(const CheckInput& input, const char* check) {
  std::vector<std::string> lines;
  for (const CheckFinding& finding : run_checks(input, {check}))
    for (const std::string& example : finding.examples)
      lines.push_back(std::string(name_of(finding.level)) + ": " + example);
  return lines;
}

TEST(PictureChecks, PicturesThatLookAlike) {
  const std::vector<DecodedImage> apart{scene(16, 200), scene(32, 200), scene(48, 200),
                                        scene(16, 0)};
  EXPECT_THAT(found(with_pictures(apart), "near_duplicates"), IsEmpty());
  std::vector<DecodedImage> alike = apart;
  alike[2] = scene(32, 202);  // a quarter of the picture by 2 of 255: 0.0039
  EXPECT_THAT(found(with_pictures(alike), "near_duplicates"),
              ElementsAre("warning: mug/2 as mug/1 (another camera)"));
  alike[2] = scene(32, 206);  // 0.0118
  EXPECT_THAT(found(with_pictures(alike), "near_duplicates"), IsEmpty());
  alike = apart;
  alike[1] = scene(16, 201);
  EXPECT_THAT(found(with_pictures(alike), "near_duplicates"),
              ElementsAre("note: mug/1 as mug/0 (another camera)"));
  CheckInput folded = with_pictures(alike);
  folded.images[0].fold = 0;
  folded.images[1].fold = 1;
  EXPECT_THAT(found(folded, "near_duplicates"),
              ElementsAre("warning: mug/1 as mug/0 (another camera)"));
  CheckInput equal = with_pictures(alike);  // told by the check of duplicates
  equal.images[1].files[0].pixels = equal.images[0].files[0].pixels;
  EXPECT_THAT(found(equal, "near_duplicates"), IsEmpty());
}

TEST(PictureChecks, FaintModelsAndSpecks) {
  std::vector<DecodedImage> pictures(3, scene(0, 0));
  for (int y = 10; y < 40; ++y)
    for (int x = 10; x < 40; ++x)
      set(pictures[0], x, y, 255);
  set(pictures[1], 50, 50, 255);
  EXPECT_THAT(found(with_pictures(pictures), "contrast"),
              ElementsAre("warning: mug/1", "warning: mug/2"));
  EXPECT_THAT(found(with_pictures(pictures), "fireflies"), ElementsAre("warning: mug/1"));
}

TEST(PictureChecks, WithoutPicturesTheyDoNotRun) {
  CheckInput input = with_pictures({scene(16, 200), scene(16, 201)});
  input.files.pictures.clear();
  for (const char* check : {"contrast", "fireflies", "near_duplicates"}) {
    EXPECT_TRUE(any_reads_pictures({"masks", check}));
    EXPECT_THAT(run_checks(input, {check}), IsEmpty());
  }
  EXPECT_FALSE(any_reads_pictures({"masks"}));
}

}  // namespace
}  // namespace ds
