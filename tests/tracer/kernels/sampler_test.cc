// SPDX-License-Identifier: Apache-2.0
// kernels/sampler.h: the points' stratification, independence and ranges.
#include "tests/tracer/kernels/chi_square.h"
#include "tracer/kernels/all_nodes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace ds {
namespace {

using namespace kernels;

real2 point(std::uint32_t seed, std::uint32_t pixel, std::uint32_t sample, std::uint32_t pair) {
  return sample_pair(sampler_for(seed, seed * 7 + 1, pixel, sample), pair);
}

/// Samples of one parity are one sequence; the two are independent, so that their difference tells
/// a picture's error.
std::uint32_t sample_number(std::uint32_t i, std::uint32_t parity) {
  return 2 * i + parity;
}

TEST(Sampler, PairsAreNetsOfElementaryIntervals) {
  // Of the first 2^k points, each box of 2^-i by 2^-(k-i) holds one (a (0,2)-net).
  for (std::uint32_t k = 0; k <= 8; ++k)
    for (const std::uint32_t seed : {0u, 1u, 0xdeadbeefu})
      for (const std::uint32_t pixel : {0u, 12345u})
        for (const std::uint32_t pair : {0u, 1u, 5u, 1000u}) {
          const std::uint32_t n = 1u << k;
          for (std::uint32_t i = 0; i <= k; ++i) {
            std::set<std::uint32_t> boxes;
            for (std::uint32_t s = 0; s < n; ++s) {
              const real2 p = point(seed, pixel, sample_number(s, pixel & 1u), pair);
              const auto column = static_cast<std::uint32_t>(p.x * static_cast<float>(1u << i));
              const auto row = static_cast<std::uint32_t>(p.y * static_cast<float>(1u << (k - i)));
              boxes.insert((column << (k - i)) + row);
            }
            ASSERT_EQ(boxes.size(), n)
                << "2^" << k << " points, boxes 2^-" << i << " wide, pair " << pair;
          }
        }
}

TEST(Sampler, LaterBlocksAreNetsToo) {
  for (std::uint32_t block = 1; block < 6; ++block) {
    std::set<std::uint32_t> boxes;
    for (std::uint32_t s = 0; s < 64; ++s) {
      const real2 p = point(3, 77, sample_number(block * 64 + s, block & 1u), 2);
      boxes.insert(static_cast<std::uint32_t>(p.x * 8) * 8 + static_cast<std::uint32_t>(p.y * 8));
    }
    EXPECT_EQ(boxes.size(), 64u);
  }
}

/// Chance that first(i) and second(i) are independent and uniform, from 16 x 16 joint cells.
template <typename First, typename Second>
double chance_of_independence(std::uint32_t count, const First& first, const Second& second) {
  std::vector<double> counts(256), expected(256, count / 256.0);
  for (std::uint32_t i = 0; i < count; ++i)
    counts[static_cast<std::size_t>(first(i) * 16) * 16 +
           static_cast<std::size_t>(second(i) * 16)] += 1;
  return chance_of_counts(counts, expected);
}

TEST(Sampler, PairsPixelsAndSeedsAreIndependent) {
  // Over pixels of one sample: there is no stratification between pixels, so the counts are those
  // of chance.
  constexpr std::uint32_t k_count = 100000;
  const double limit = sidak(20);
  for (std::uint32_t pair = 0; pair < 4; ++pair) {
    EXPECT_GT(chance_of_independence(
                  k_count, [&](auto i) { return point(1, i, 3, pair).x; },
                  [&](auto i) { return point(1, i, 3, pair).y; }),
              limit);
    EXPECT_GT(chance_of_independence(
                  k_count, [&](auto i) { return point(1, i, 3, pair).x; },
                  [&](auto i) { return point(1, i, 3, pair + 1).x; }),
              limit);
    EXPECT_GT(chance_of_independence(
                  k_count, [&](auto i) { return point(1, i, 3, pair).y; },
                  [&](auto i) { return point(1, i + 1, 3, pair).y; }),
              limit);
    EXPECT_GT(chance_of_independence(
                  k_count, [&](auto i) { return point(1, i, 3, pair).x; },
                  [&](auto i) { return point(1, i, 4, pair).x; }),
              limit);
    EXPECT_GT(chance_of_independence(
                  k_count, [&](auto i) { return point(1, i, 3, pair).x; },
                  [&](auto i) { return point(0x9e3779b9u, i, 3, pair).x; }),
              limit);
  }
}

TEST(Sampler, TheTwoHalvesAreIndependent) {
  EXPECT_GT(chance_of_independence(
                100000, [](auto i) { return point(1, i, 6, 2).x; },
                [](auto i) { return point(1, i, 7, 2).x; }),
            0.001);
}

TEST(Sampler, ADimensionIsUniformOverSamples) {
  std::vector<double> counts(1000), expected(1000, 65.536);
  for (std::uint32_t s = 0; s < 65536; ++s)
    counts[static_cast<std::size_t>(point(5, 6, s, 7).x * 1000)] += 1;
  // Far more even than chance.
  for (const double c : counts)
    EXPECT_NEAR(c, 65.5, 3);
}

TEST(Sampler, ScramblingMapsEachPrefixToItself) {
  // Owen's property, on reversed digits: the low k bits of the result depend on the low k bits of
  // the number alone.
  for (std::uint32_t x = 0; x < 4096; ++x)
    for (const std::uint32_t seed : {0u, 0x12345678u}) {
      const std::uint32_t low = scramble_reversed(x & 0xffu, seed) & 0xffu;
      ASSERT_EQ(scramble_reversed(x | 0xabcd0000u, seed) & 0xffu, low);
    }
  std::set<std::uint32_t> images;
  for (std::uint32_t x = 0; x < 65536; ++x)
    images.insert(scramble_reversed(x, 99) & 0xffffu);
  EXPECT_EQ(images.size(), 65536u);
}

TEST(Sampler, BitsAreReversedAndSobolsMatrixIsPascals) {
  EXPECT_EQ(reverse_bits(1), 0x80000000u);
  EXPECT_EQ(reverse_bits(0x12345678u), 0x1e6a2c48u);
  // Joe and Kuo's direction numbers of dimension 2 begin 1, 3, 5, 15: reversed digits of 1, 2,
  // 4, 8.
  EXPECT_EQ(reverse_bits(sobol_second_reversed(reverse_bits(0x80000000u))) >> 31, 1u);
  std::set<std::uint32_t> images;
  for (std::uint32_t i = 0; i < 65536; ++i)
    images.insert(mix_bits(i));
  EXPECT_EQ(images.size(), 65536u);
}

TEST(Sampler, NumbersAreBelowOne) {
  EXPECT_EQ(unit_interval(0), 0);
  EXPECT_LT(unit_interval(0xffffffffu), 1);
  EXPECT_EQ(unit_interval(0x80000000u), 0.5f);
}

TEST(ConcentricDisc, IsUniform) {
  constexpr std::uint32_t k_count = 200000;
  std::vector<double> counts(160), expected(160, k_count / 160.0);
  for (std::uint32_t i = 0; i < k_count; ++i) {
    const real2 d = concentric_disc(point(1, i, 0, 9));
    const double squared = double{d.x} * double{d.x} + double{d.y} * double{d.y};
    ASSERT_LE(squared, 1 + 1e-6);
    const double turn = (std::atan2(double{d.y}, double{d.x}) / std::numbers::pi + 1) / 2;
    counts[static_cast<std::size_t>(std::min(squared, 0.999999) * 10) * 16 +
           static_cast<std::size_t>(std::min(turn, 0.999999) * 16)] += 1;
  }
  EXPECT_GT(chance_of_counts(counts, expected), 0.01);
  EXPECT_EQ(concentric_disc({0.5f, 0.5f}).x, 0);
  for (const float x : {0.0f, 0.5f, 0.99999994f})
    for (const float y : {0.0f, 0.5f, 0.99999994f})
      ASSERT_TRUE(std::isfinite(concentric_disc({x, y}).x));
}

}  // namespace
}  // namespace ds
