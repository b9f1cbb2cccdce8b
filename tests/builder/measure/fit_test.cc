// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace ds {
namespace {

using Values = std::vector<double>;

TEST(Fit, StudentsQuantiles) {
  // scipy.stats.t.ppf(0.975, n)
  EXPECT_NEAR(student_t95(1), 12.706204736, 1e-3);
  EXPECT_NEAR(student_t95(5), 2.570581836, 1e-3);
  EXPECT_NEAR(student_t95(11), 2.200985160, 2e-3);
  EXPECT_NEAR(student_t95(30), 2.042272456, 1e-4);
  EXPECT_NEAR(student_t95(100), 1.983971519, 1e-5);
}

TEST(Fit, MeanMedianAndDeviation) {
  EXPECT_EQ(median_of({5, 1, 3}), 3);
  EXPECT_EQ(median_of({5, 1, 3, 2}), 2.5);
  EXPECT_NEAR(deviation_of(Values{2, 4, 4, 4, 5, 5, 7, 9}), std::sqrt(32.0 / 7), 1e-12);
  const Interval mean = mean_interval(Values{1, 2, 3});
  EXPECT_EQ(mean.value, 2);
  EXPECT_NEAR(mean.high - mean.value, 4.303 / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(mean.value - mean.low, mean.high - mean.value, 1e-12);
  const Interval one = mean_interval(Values{7});
  EXPECT_EQ(one.low, 7);
  EXPECT_EQ(one.high, 7);
}

TEST(Fit, AnEndThatChancePutBelowZeroIsOpen) {
  const auto root = [](double square) { return std::sqrt(square); };
  // Two seeds: 0.0044 +- 12.7 * 0.0020, far below 0.
  const Values scattered{0.0024, 0.0064};
  const Interval error = mapped_interval(scattered, root, 0).value();
  EXPECT_NEAR(error.value, std::sqrt(0.0044), 1e-12);
  EXPECT_EQ(error.low, 0);
  EXPECT_NEAR(error.high, std::sqrt(0.0044 + 12.706 * 0.0020), 1e-9);

  const double infinity = std::numeric_limits<double>::infinity();
  const auto decibels = [](double square) { return -10 * std::log10(square); };
  const Interval falling = mapped_interval(scattered, decibels, infinity).value();
  EXPECT_EQ(falling.high, infinity);
  EXPECT_LT(falling.low, falling.value);
  EXPECT_LT(falling.value, 1000);

  const Interval sure = mapped_interval(Values{4, 4.001, 3.999}, root, 0).value();
  EXPECT_NEAR(sure.low, 2, 0.001);
  EXPECT_LT(sure.low, sure.value);
  EXPECT_FALSE(mapped_interval(Values{-0.001, 0.0005}, root, 0).has_value());
}

TEST(Fit, TwoPointsLeaveASlopeOpen) {
  const Interval slope = fit_line(Values{1, 2}, Values{1, 3}).slope_interval();
  EXPECT_EQ(slope.value, 2);
  EXPECT_TRUE(std::isinf(slope.low) && slope.low < 0);
  EXPECT_TRUE(std::isinf(slope.high) && slope.high > 0);
  const Interval n = fit_power_law(Values{1, 4}, Values{0.4, 0.2})->n_for(0.1).value();
  EXPECT_NEAR(n.value, 16, 1e-9);
  EXPECT_EQ(n.low, 0);
  EXPECT_TRUE(std::isinf(n.high));
}

TEST(Fit, LineIsThatOfScipy) {
  // scipy.stats.linregress(log([1, 2, 4, 8]), log([0.4, 0.27, 0.21, 0.14]))
  const Values n{1, 2, 4, 8};
  const auto law = fit_power_law(n, Values{0.4, 0.27, 0.21, 0.14});
  ASSERT_TRUE(law.has_value());
  EXPECT_NEAR(law->line.slope, -0.4906289597873984, 1e-12);
  EXPECT_NEAR(law->line.intercept, -0.9279790438573137, 1e-12);
  const Interval slope = law->line.slope_interval();
  EXPECT_NEAR(slope.high - slope.value, student_t95(2) * 0.03031649212319938, 1e-9);
}

TEST(Fit, AnExactPowerLawIsFoundAndInverted) {
  Values n, errors;
  for (int spp = 1; spp <= 256; spp *= 4) {
    n.push_back(spp);
    errors.push_back(0.8 * std::pow(spp, -0.5));
  }
  const auto law = fit_power_law(n, errors);
  ASSERT_TRUE(law.has_value());
  EXPECT_NEAR(law->line.slope, -0.5, 1e-12);
  EXPECT_NEAR(law->error(1024), 0.025, 1e-12);
  const Interval at = law->n_for(0.01).value();
  EXPECT_NEAR(at.value, 6400, 1e-6);
  EXPECT_NEAR(at.low, 6400, 1e-3);
  EXPECT_EQ(law->least_n, 1);
  EXPECT_NEAR(law->most_n, 256, 1e-9);
}

TEST(Fit, ScatterWidensTheInverse) {
  const Values n{1, 2, 4, 8, 16};
  const auto law = fit_power_law(n, Values{1.1, 0.65, 0.55, 0.33, 0.26});
  const Interval near = law->n_for(0.5).value();
  const Interval far = law->n_for(0.01).value();
  EXPECT_LT(near.low, near.value);
  EXPECT_LT(near.value, near.high);
  EXPECT_GT(far.high / far.low, near.high / near.low);
}

TEST(Fit, ErrorsLostInTheNoiseAreLeftOut) {
  const auto law = fit_power_law(Values{1, 4, 16}, Values{0.4, 0.2, 0});
  ASSERT_TRUE(law.has_value());
  EXPECT_NEAR(law->most_n, 4, 1e-12);
  EXPECT_FALSE(fit_power_law(Values{1, 4}, Values{0.4, 0}).has_value());
  EXPECT_FALSE(fit_power_law(Values{1, 4}, Values{0.2, 0.4})->n_for(0.01).has_value());
}

}  // namespace
}  // namespace ds
