// SPDX-License-Identifier: Apache-2.0
#include "manifests/pixel_counts.h"

#include "tracer/base/error.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <vector>

namespace ds {
namespace {

TEST(PixelCountsTest, a_picture_is_lit_above_4) {
  const std::vector<std::uint8_t> rgb{0, 0, 0, 4,   4,   4,   0,   5,   0,
                                      9, 9, 9, 255, 255, 254, 255, 255, 255};
  const PixelCounts counts = count_picture(rgb, 3);
  EXPECT_EQ(counts.lit, 4U);
  EXPECT_FALSE(counts.white || counts.model || counts.frame);
}

TEST(PixelCountsTest, a_mask_touches_the_frame_in_its_outer_rows_and_columns) {
  constexpr int k_width = 5, k_height = 4;
  for (int y = 0; y < k_height; ++y) {
    for (int x = 0; x < k_width; ++x) {
      std::vector<std::uint8_t> mask(k_width * k_height, 0);
      mask[static_cast<std::size_t>(y * k_width + x)] = 255;
      const PixelCounts counts = count_mask(mask, k_width, k_height);
      const bool inner = x > 0 && y > 0 && x < k_width - 1 && y < k_height - 1;
      EXPECT_EQ(counts.model, 1U);
      EXPECT_EQ(counts.frame, inner ? 0U : 1U) << x << " " << y;
      EXPECT_FALSE(counts.lit || counts.white);
      EXPECT_EQ(counts.left, static_cast<std::uint64_t>(x));
      EXPECT_EQ(counts.right, static_cast<std::uint64_t>(k_width - 1 - x));
      EXPECT_EQ(counts.above, static_cast<std::uint64_t>(y));
      EXPECT_EQ(counts.below, static_cast<std::uint64_t>(k_height - 1 - y));
    }
  }
  const std::vector<std::uint8_t> full(k_width * k_height, 255);
  EXPECT_EQ(count_mask(full, k_width, k_height).frame, 14U);
  EXPECT_EQ(count_mask(full, k_width, k_height).right, 0U);
  const PixelCounts none = count_mask(std::vector<std::uint8_t>(20, 0), k_width, k_height);
  EXPECT_EQ(none.left, 5U);
  EXPECT_EQ(none.below, 4U);
}

TEST(PixelCountsTest, an_object_is_where_its_id_is) {
  constexpr int k_width = 4, k_height = 3;
  std::vector<float> ids(k_width * k_height), alone(k_width * k_height, 0.0f);
  for (const std::size_t at : {5U, 6U, 9U})
    ids[at] = std::bit_cast<float>(std::uint32_t{101});
  ids[0] = std::bit_cast<float>(std::uint32_t{102});
  for (const std::size_t at : {1U, 2U, 5U, 6U, 9U})
    alone[at] = 1;
  const ObjectCounts counts = count_object(101, ids, alone, k_width, k_height);
  EXPECT_EQ(counts, (ObjectCounts{101, 3, 5, 1, 1, 1, 1, 0}));
  PixelCounts all;
  all.objects = {counts, count_object(103, ids, alone, k_width, k_height)};
  EXPECT_EQ(all.objects[1].seen, 0U);
  EXPECT_EQ(pixel_counts_from(to_json_value(all)), all);
  PixelCounts none;
  add_counts(none, all);
  EXPECT_EQ(none.objects, all.objects);
  EXPECT_THROW(pixel_counts_from({{"objects", {{{"id", 1}}}}}), Error);
  EXPECT_THROW(pixel_counts_from({{"objects", {{{"seen", 1}}}}}), Error);
  EXPECT_THROW(pixel_counts_from({{"objects", {{"id", 1}}}}), Error);
}

TEST(PixelCountsTest, what_was_not_counted_stays_absent) {
  PixelCounts counts{{}, {}, 7, 0};
  EXPECT_EQ(to_json_value(counts).dump(), R"({"frame":0,"model":7})");
  EXPECT_EQ(pixel_counts_from(to_json_value(counts)), counts);
  EXPECT_EQ(pixel_counts_from(nlohmann::json::object()), PixelCounts{});
  add_counts(counts, {3, 1, 9, 9});
  EXPECT_EQ(counts, (PixelCounts{3, 1, 7, 0}));
  EXPECT_THROW(pixel_counts_from({{"lit", -1}}), Error);
  EXPECT_THROW(pixel_counts_from({{"lit", "3"}}), Error);
  EXPECT_THROW(pixel_counts_from(nlohmann::json::array()), Error);
}

}  // namespace
}  // namespace ds
