// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/canonical.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>

namespace ds {
namespace {

TEST(CanonicalTest, hex_floats_are_exact) {
  for (const float value : {0.1f, 1.0f, -0.0f, 1e-45f, 3.4e38f, 0.3333333f}) {
    EXPECT_EQ(std::strtof(hex_float(value).c_str(), nullptr), value) << hex_float(value);
  }
  EXPECT_EQ(hex_float(0.75f), "0x1.8p-1");
  EXPECT_NE(hex_float(0.0f), hex_float(-0.0f));
  EXPECT_EQ(hex_float(std::numeric_limits<double>::quiet_NaN()), "nan");
}

TEST(CanonicalTest, hex_floats_are_those_of_c) {
  const auto expect_same = [](double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%a", value);
    EXPECT_EQ(hex_float(value), text);
  };
  for (const double value : {0.0, -0.0, 1.0, -1.0, 0.1, 5e-324, -2.3e-308, 2.2250738585072014e-308,
                             1.7976931348623157e308, 1e-310, 4096.0, 1.0625})
    expect_same(value);
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i)
    if (const auto value = std::bit_cast<double>(random()); std::isfinite(value)) {
      expect_same(value);
      expect_same(double{static_cast<float>(i) / 7});
    }
}

TEST(CanonicalTest, an_entry_is_one_line_and_reads_back) {
  CanonicalText text;
  text.add("a", 3);
  text.add("b", "x\ny\\");
  text.add("c", std::span<const float>(std::array{1.0f, 0.5f}));
  EXPECT_EQ(text.text(), "a = 3\nb = x\\ny\\\\\nc = 0x1p+0 0x1p-1\n");
  const auto entries = parse_canonical(text.text());
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[2].first, "c");
  EXPECT_EQ(entries[1].second, "x\\ny\\\\");
}

}  // namespace
}  // namespace ds
