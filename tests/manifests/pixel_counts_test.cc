// SPDX-License-Identifier: Apache-2.0
#include "manifests/pixel_counts.h"

#include "tracer/base/error.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
