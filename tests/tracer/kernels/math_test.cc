// SPDX-License-Identifier: Apache-2.0
// kernels/math.h and vec.h against libm in double, over the domains and to the bounds they state.
#include "tracer/kernels/all_nodes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

namespace ds {
namespace {

using namespace kernels;

constexpr double k_pi = std::numbers::pi;
constexpr int k_tries = 400000;

/// Greatest |got - want| / scale(x) over random x of a range, in the stated bound's units.
double worst(double low, double high, const std::function<double(float)>& got,
             const std::function<double(double)>& want,
             const std::function<double(double)>& scale) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(low, high);
  double most = 0;
  for (int i = 0; i < k_tries; ++i) {
    const auto x = static_cast<float>(u(random));
    most = std::max(most, std::fabs(got(x) - want(double{x})) / scale(double{x}));
  }
  return most;
}

double one(double) {
  return 1;
}

TEST(Math, SinAndCosOfTurns) {
  for (const double range : {1.0, 1000.0, 1048576.0}) {
    EXPECT_LT(worst(
                  -range, range, [](float u) { return double{sin_cos_turns(u).sin}; },
                  [](double u) { return std::sin(2 * k_pi * (u - std::floor(u))); }, one),
              2e-7);
    EXPECT_LT(worst(
                  -range, range, [](float u) { return double{sin_cos_turns(u).cos}; },
                  [](double u) { return std::cos(2 * k_pi * (u - std::floor(u))); }, one),
              2e-7);
  }
  for (const float quarter : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f, -0.25f}) {
    EXPECT_NEAR(double{sin_cos_turns(quarter).sin}, std::sin(2 * k_pi * double{quarter}), 1e-7);
    EXPECT_NEAR(double{sin_cos_turns(quarter).cos}, std::cos(2 * k_pi * double{quarter}), 1e-7);
  }
}

TEST(Math, Sine) {
  EXPECT_LT(worst(
                -1e4, 1e4, [](float x) { return double{sine(x)}; },
                [](double x) { return std::sin(x); }, [](double x) { return std::fabs(x) + 1; }),
            1e-6);
}

TEST(Math, Exponential) {
  EXPECT_LT(worst(
                -80, 80, [](float x) { return double{exponential(x)}; },
                [](double x) { return std::exp(x); }, [](double x) { return std::exp(x); }),
            3e-7);
  EXPECT_EQ(exponential(0), 1);
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float x : {-1e30f, -infinity, -100.0f, 100.0f, 1e30f, infinity}) {
    EXPECT_GE(exponential(x), 0x1p-127f) << x;
    EXPECT_LE(exponential(x), 0x1p127f) << x;
  }
}

TEST(Math, Logarithm) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> exponent(-126, 127.9);
  for (int i = 0; i < k_tries; ++i) {
    const auto x = static_cast<float>(std::exp2(exponent(random)));
    const double want = std::log(double{x});
    ASSERT_NEAR(double{logarithm(x)}, want, 1e-7 * (std::fabs(want) + 1)) << x;
  }
  EXPECT_EQ(logarithm(1), 0);
  for (const float x : {0.0f, -1.0f, 1e-40f, -std::numeric_limits<float>::infinity()})
    EXPECT_NEAR(double{logarithm(x)}, std::log(0x1p-126), 1e-5) << x;
}

TEST(Math, Power) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> a(0, 10), b(0, 8);
  for (int i = 0; i < k_tries; ++i) {
    const float x = a(random), y = b(random);
    const double want = std::pow(double{x}, double{y});
    if (want < 1e-30) continue;
    // 1e-7 of b ln a, as a relative error.
    ASSERT_NEAR(double{power(x, y)} / want, 1,
                4e-7 + 3e-7 * double{y} * (1 + std::fabs(std::log(double{x}))))
        << x << " ^ " << y;
  }
  EXPECT_EQ(power(0, 2), 0);
  EXPECT_EQ(power(0, 0), 1);
  EXPECT_EQ(power(1, 1000), 1);
}

TEST(Math, ArctangentInTurns) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> exponent(-30, 30);
  for (int i = 0; i < k_tries; ++i) {
    const auto y = static_cast<float>(std::pow(10, exponent(random)) * (i & 1 ? -1 : 1));
    const auto x = static_cast<float>(i % 8 < 6 ? double{y} * (exponent(random) / 10)
                                                : std::pow(10, exponent(random)));
    ASSERT_NEAR(double{arctangent_turns(y, x)}, std::atan2(double{y}, double{x}) / (2 * k_pi), 1e-7)
        << y << ", " << x;
  }
  EXPECT_EQ(arctangent_turns(0, 0), 0);
  EXPECT_EQ(arctangent_turns(0, 1), 0);
  EXPECT_EQ(arctangent_turns(0, -1), 0.5f);
  EXPECT_EQ(arctangent_turns(1, 0), 0.25f);
  EXPECT_EQ(arctangent_turns(-1, 0), -0.25f);
  EXPECT_TRUE(std::isfinite(arctangent_turns(1e-40f, 1e-40f)));
}

TEST(Math, ArccosineInTurns) {
  EXPECT_LT(worst(
                -1, 1, [](float z) { return double{arccosine_turns(z)}; },
                [](double z) { return std::acos(z) / (2 * k_pi); }, one),
            2e-7);
  EXPECT_EQ(arccosine_turns(1), 0);
  EXPECT_EQ(arccosine_turns(-1), 0.5f);
  EXPECT_TRUE(std::isfinite(arccosine_turns(1.0000001f)));
}

TEST(Math, SumsOfManyFloatsAreThoseOfDoubles) {
  // Equal addends, whose rounding errs the same way each time, and addends of all sizes and signs.
  for (const bool equal : {true, false}) {
    std::mt19937 random(6);
    std::uniform_real_distribution<float> exponent(-20, 20);
    float sum = 0, rest = 0;
    double exact = 0, size = 0;
    for (int i = 0; i < 1000000; ++i) {
      const float x = equal ? 0.1f : (i % 3 == 0 ? -1.0f : 1.0f) * std::exp2(exponent(random));
      add_compensated(&sum, &rest, x);
      exact += double{x};
      size += std::fabs(double{x});
    }
    // 2^-46 for each of a million additions, of the sizes they had: far below a float's own ulp.
    EXPECT_NEAR(double{sum} + double{rest}, exact, 1e-11 * size) << equal;
  }
}

TEST(Math, IntegersOfWhatNoIntHolds) {
  EXPECT_EQ(to_held_integer(3e9f), 1 << 30);
  EXPECT_EQ(to_held_integer(-1e30f), -(1 << 30));
  EXPECT_EQ(to_held_integer(std::numeric_limits<float>::infinity()), 1 << 30);
  EXPECT_EQ(to_held_integer(std::numeric_limits<float>::quiet_NaN()), -(1 << 30));
  EXPECT_EQ(to_held_integer(-7.0f), -7);
  for (const float x : {1e10f, 1e30f, std::numeric_limits<float>::infinity()})
    EXPECT_TRUE(std::fabs(sine(x)) <= 1) << x;
}

TEST(Math, NanEndsAndStaysInItsLane) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  // No loop depends on a value; nothing to wait for. What comes out is not asked, but exponential's
  // is held in range.
  (void)logarithm(nan);
  (void)arctangent_turns(nan, 1);
  EXPECT_TRUE(exponential(nan) >= 0 || std::isnan(exponential(nan)));
  EXPECT_EQ(safe_sqrt(nan), 0);
  EXPECT_EQ(safe_sqrt(-1e-7f), 0);
  EXPECT_EQ(clamp01(nan), 0);
}

TEST(Vectors, FramesAreOrthonormal) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> u(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    real3 n = unit(vec(u(random), u(random), u(random)));
    if (i % 10 == 0)
      n = unit(vec(1e-6f * u(random), 1e-6f * u(random), i % 20 == 0 ? 1.0f : -1.0f));
    const Frame f = frame_around(n);
    for (const auto& [a, b, want] : {std::tuple{f.t, f.t, 1.0f},
                                     {f.b, f.b, 1.0f},
                                     {f.t, f.b, 0.0f},
                                     {f.t, f.n, 0.0f},
                                     {f.b, f.n, 0.0f}})
      ASSERT_NEAR(dot(a, b), want, 1e-6);
    ASSERT_GT(dot(cross(f.t, f.b), f.n), 0.999f);
    const real3 v = vec(u(random), u(random), u(random));
    const real3 back = to_world(f, to_local(f, v));
    ASSERT_LT(std::fabs(back.x - v.x) + std::fabs(back.y - v.y) + std::fabs(back.z - v.z), 3e-6f);
  }
}

TEST(Vectors, UnitIsNeverNan) {
  EXPECT_NEAR(double{dot(unit(vec(1e15f, 0, 0)), unit(vec(1e15f, 0, 0)))}, 1, 1e-6);
  EXPECT_EQ(unit(vec(0, 0, 0)).x, 0);
  EXPECT_LE(unit(vec(1e-20f, 0, 0)).x, 1);
}

}  // namespace
}  // namespace ds
