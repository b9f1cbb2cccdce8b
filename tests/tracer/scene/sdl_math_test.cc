// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ds::portable {
namespace {

// libm is the independent source: it is within one unit in the last place, and so must these be,
// but for a few.
constexpr double k_relative = 1e-14;

TEST(PortableMath, ExpLogPow) {
  for (double x = -700; x < 700; x += 0.37)
    EXPECT_NEAR(exp(x) / std::exp(x), 1, k_relative) << x;
  for (double x = 1e-300; x < 1e300; x *= 3.7)
    EXPECT_NEAR(log(x), std::log(x), k_relative * std::fmax(1, std::fabs(std::log(x)))) << x;
  for (double x = 0.9; x < 1.1; x += 0.001)
    EXPECT_NEAR(log(x), std::log(x), 1e-16 + k_relative * std::fabs(std::log(x))) << x;
  for (double y = -4; y < 4; y += 0.3)
    EXPECT_NEAR(pow(2.3, y) / std::pow(2.3, y), 1, k_relative) << y;
  EXPECT_EQ(pow(0, 2.2), 0);
  EXPECT_EQ(pow(0, 0), 1);
  EXPECT_EQ(pow(1, 2.2), 1);
  EXPECT_EQ(exp(-1000), 0);
  EXPECT_EQ(exp(1000), std::numeric_limits<double>::infinity());
  EXPECT_EQ(exp(0), 1);
  EXPECT_EQ(log(1), 0);
}

TEST(PortableMath, SinCos) {
  for (double x = -1000; x < 1000; x += 0.313) {
    EXPECT_NEAR(sin(x), std::sin(x), 1e-13) << x;
    EXPECT_NEAR(cos(x), std::cos(x), 1e-13) << x;
  }
  EXPECT_EQ(cos(0), 1);
  EXPECT_EQ(sin(0), 0);
}

TEST(PortableMath, Atan2AndAcos) {
  for (int i = 0; i < 1000; ++i) {
    const double angle = -3.1 + i * 0.0062;
    EXPECT_NEAR(atan2(2 * std::sin(angle), 2 * std::cos(angle)), angle, 1e-14);
    const double x = -1 + i * 0.002;
    EXPECT_NEAR(acos(x), std::acos(x), 1e-14) << x;
  }
  EXPECT_EQ(acos(1), 0);
  EXPECT_DOUBLE_EQ(acos(-1), k_pi);
  EXPECT_EQ(atan2(0, 0), 0);
}

TEST(PortableMath, InverseOfAnAffineMatrix) {
  Mat4 m;
  m.m = {1, 2, 3, 4, 0, -1, 5, 6, 2, 0, 1, 7, 0, 0, 0, 1};
  const Mat4 product = m * inverse(m);
  for (std::size_t i = 0; i < 16; ++i)
    EXPECT_NEAR(product.m[i], Mat4{}.m[i], 1e-14) << i;
  EXPECT_DOUBLE_EQ(determinant(m), 1 * (-1 - 0) - 2 * (0 - 10) + 3 * (0 + 2));
}

}  // namespace
}  // namespace ds::portable
