// SPDX-License-Identifier: Apache-2.0
#include "manifests/export/export.h"

#include "manifests/export/outlines.h"
#include "manifests/export/run_lengths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ds {
namespace {

using testing::ElementsAre;

/// What the polygon fills by the even-odd rule, pixel by pixel.
std::vector<std::uint8_t> filled(const std::vector<std::array<int, 2>>& polygon, int width,
                                 int height) {
  std::vector<std::uint8_t> values;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      bool inside = false;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto [ax, ay] = polygon[i];
        const auto [bx, by] = polygon[(i + 1) % polygon.size()];
        const double at = y + 0.5;
        if ((ay > at) != (by > at) && x + 0.5 < ax + (at - ay) / (by - ay) * (bx - ax))
          inside = !inside;
      }
      values.push_back(inside ? 1 : 0);
    }
  return values;
}

TEST(Outline, FillsToTheMask) {
  EXPECT_TRUE(outline_of({2, 2, {0, 0, 0, 0}}).empty());
  EXPECT_THAT(outline_of({2, 1, {0, 1}}),
              ElementsAre(std::array{1, 0}, std::array{2, 0}, std::array{2, 1}, std::array{1, 1}));
  // Every mask of 4 x 4 pixels: holes, pieces, pieces that touch in a corner.
  for (unsigned bits = 0; bits < 1U << 16U; bits += 3) {
    MaskPixels mask{4, 4, {}};
    for (unsigned i = 0; i < 16; ++i)
      mask.values.push_back((bits >> i) & 1U);
    ASSERT_EQ(filled(outline_of(mask), 4, 4), mask.values) << bits;
  }
}

TEST(ExportKey, IsOneWordWithoutDots) {
  EXPECT_EQ(export_key("mug.ply/1", "mug.ply", KeyForm::stem), "mug-1");
  EXPECT_EQ(export_key("mug.ply/1-red-room", "mug.ply", KeyForm::stem), "mug-1-red-room");
  EXPECT_EQ(export_key("mug.ply/1", "mug.ply", KeyForm::ending), "mug_ply-1");
  EXPECT_EQ(export_key("my mug.v2.ply/1", "my mug.v2.ply", KeyForm::stem), "my_mug_v2-1");
  EXPECT_EQ(export_key("chairs/a.off/3", "chairs/a.off", KeyForm::stem), "chairs-a-3");
  EXPECT_EQ(export_key("v1.0/a/3", "v1.0/a", KeyForm::stem), "v1_0-a-3");
  EXPECT_EQ(export_key("t\xc3\xbcr.off/0", "t\xc3\xbcr.off", KeyForm::stem), "t\xc3\xbcr-0");
}

TEST(ExportKey, OfLongNamesIsShortAndTheirOwn) {
  const std::string a = std::string(250, 'a') + "b.off", b = std::string(250, 'a') + "c.off";
  const std::string key = export_key(a + "/12", a, KeyForm::stem);
  EXPECT_EQ(key.size(), 64u + 3u);
  EXPECT_TRUE(key.ends_with("-12")) << key;
  EXPECT_NE(key, export_key(b + "/12", b, KeyForm::stem));
  // No character of two bytes is torn.
  std::string wide;
  for (int i = 0; i < 60; ++i)
    wide += "\xc3\xbc";
  const std::string cut = export_key(wide, wide, KeyForm::stem);
  EXPECT_EQ(cut.substr(0, 54), wide.substr(0, 54));
  EXPECT_EQ(cut[54], '_');
  EXPECT_NE(export_key("a b.off", "a b.off", KeyForm::hash),
            export_key("a_b.off", "a_b.off", KeyForm::hash));
}

TEST(Patterns, AreGlobs) {
  EXPECT_TRUE(matches_pattern("vehicle/car", "vehicle/*"));
  EXPECT_TRUE(matches_pattern("", "*"));
  EXPECT_TRUE(matches_pattern("abcabd", "*ab?"));
  EXPECT_TRUE(matches_pattern("abc", "a**c"));
  EXPECT_FALSE(matches_pattern("abc", "ab"));
  EXPECT_FALSE(matches_pattern("", "?"));
  EXPECT_FALSE(matches_pattern("vehicle", "vehicle/*"));
}

// Worked by hand after COCO's definition: columns, first the zeros.
TEST(RunLengths, GoDownTheColumns) {
  const MaskPixels mask{3,
                        2,
                        {0, 1, 1,  //
                         0, 0, 1}};
  EXPECT_THAT(run_lengths(mask), ElementsAre(2u, 1u, 1u, 2u));
  EXPECT_EQ(area_of(mask), 3u);
  EXPECT_EQ(*tight_box(mask), (std::array{1, 0, 2, 2}));
  EXPECT_THAT(run_lengths({1, 2, {7, 0}}), ElementsAre(0u, 1u, 1u));
  EXPECT_THAT(run_lengths({2, 1, {0, 0}}), ElementsAre(2u));
  EXPECT_EQ(tight_box({2, 1, {0, 0}}), std::nullopt);
}

// 2 -> '2'; 1 -> '1'; 1 -> '1'; 2 - 1 -> '1'. 40 = 8 + 32, so 'X' (8 + 32 + 48) and '1'. 16 needs a
// second character, since bit 4 of the last is the sign. -16 is one, 'P' - ... : 16 + 48 = '@'.
TEST(RunLengths, AreWrittenInFiveBits) {
  EXPECT_EQ(run_length_text({2, 1, 1, 2}), "2111");
  EXPECT_EQ(run_length_text({40}), "X1");
  EXPECT_EQ(run_length_text({16}), "`0");
  EXPECT_EQ(run_length_text({0, 17, 5, 1}), "0a05@");
}

}  // namespace
}  // namespace ds
