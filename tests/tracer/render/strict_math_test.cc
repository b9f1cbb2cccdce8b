// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/strict_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace ds {
namespace {

double relative_error(double got, long double want) {
  return static_cast<double>(std::fabs((static_cast<long double>(got) - want) / want));
}

TEST(StrictMath, LogAgreesWithLongDouble) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-300, 300);
  for (int i = 0; i < 200'000; ++i) {
    const double x = std::pow(10.0, exponent(random));
    EXPECT_LT(relative_error(strict_log(x), std::log(static_cast<long double>(x))), 1e-15) << x;
  }
  EXPECT_EQ(strict_log(1.0), 0.0);
}

TEST(StrictMath, LogNearOneKeepsItsRelativeError) {
  for (double d = 1e-16; d < 0.5; d *= 1.7)
    for (const double x : {1.0 + d, 1.0 - d})
      if (x != 1.0) {
        EXPECT_LT(relative_error(strict_log(x), std::log(static_cast<long double>(x))), 1e-15) << d;
      }
}

TEST(StrictMath, ExpAgreesWithLongDouble) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> range(-700, 700);
  for (int i = 0; i < 200'000; ++i) {
    const double x = range(random);
    EXPECT_LT(relative_error(strict_exp(x), std::exp(static_cast<long double>(x))), 1e-15) << x;
  }
  EXPECT_EQ(strict_exp(0.0), 1.0);
  EXPECT_EQ(strict_exp(-1e4), 0.0);
  EXPECT_EQ(strict_exp(1e4), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(strict_exp(-744.0), std::exp(-744.0), 5e-324);
}

TEST(StrictMath, PowAgreesWithLongDouble) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-9, 9), power(-4, 4);
  for (int i = 0; i < 200'000; ++i) {
    const double x = std::pow(10.0, exponent(random)), y = power(random);
    EXPECT_LT(relative_error(strict_pow(x, y),
                             std::pow(static_cast<long double>(x), static_cast<long double>(y))),
              1e-13)
        << x << " " << y;
  }
  EXPECT_EQ(strict_pow(0.0, 2.2), 0.0);
  EXPECT_EQ(strict_pow(1.0, 2.2), 1.0);
}

TEST(StrictMath, DenormalsAreNoSpecialCase) {
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_LT(relative_error(strict_log(least), std::log(static_cast<long double>(least))), 1e-15);
}

// The bits themselves: a compiler that contracts or reorders changes them on machines that have
// fma.
TEST(StrictMath, KeepsItsBits) {
  EXPECT_EQ(strict_log(0.7), -0x1.6d3c324e13f5p-2);
  EXPECT_EQ(strict_exp(1.0), 0x1.5bf0a8b14576ap+1);
  EXPECT_EQ(strict_pow(0.5, 1 / 2.2), 0x1.75a07cfb107eep-1);
}

}  // namespace
}  // namespace ds
