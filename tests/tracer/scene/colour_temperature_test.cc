// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/colour_temperature.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace ds {
namespace {

/// The colour matching functions of CIE 1931 as sums of halves of Gaussians: Wyman et al., Simple Analytic
/// Approximations to the CIE XYZ Color Matching Functions, JCGT 2 (2013), listing 1.
std::array<double, 3> matched(double nm) {
  const auto bump = [&](double middle, double below, double above) {
    const double t = (nm - middle) * (nm < middle ? below : above);
    return std::exp(-0.5 * t * t);
  };
  return {0.362 * bump(442, 0.0624, 0.0374) + 1.056 * bump(599.8, 0.0264, 0.0323) -
              0.065 * bump(501.1, 0.0490, 0.0382),
          0.821 * bump(568.8, 0.0213, 0.0247) + 0.286 * bump(530.9, 0.0613, 0.0322),
          1.217 * bump(437, 0.0845, 0.0278) + 0.681 * bump(459, 0.0385, 0.0725)};
}

// Against Planck's law itself.
TEST(BlackBodyColour, IsThatOfPlancksLaw) {
  for (const double kelvin : {2000.0, 2700.0, 3500.0, 4500.0, 5500.0, 6500.0, 8000.0, 12000.0}) {
    double x = 0, y = 0, z = 0;
    for (double nm = 360; nm <= 830; ++nm) {
      const double m = nm * 1e-9;
      const double power = std::pow(m, -5) / std::expm1(1.438776877e-2 / (m * kelvin));
      const auto [a, b, c] = matched(nm);
      x += power * a;
      y += power * b;
      z += power * c;
    }
    const std::array<double, 3> right{(3.2404542 * x - 1.5371385 * y - 0.4985314 * z) / y,
                                      (-0.9692660 * x + 1.8760108 * y + 0.0415560 * z) / y,
                                      (0.0556434 * x - 0.2040259 * y + 1.0572252 * z) / y};
    const Vec3d colour = black_body_colour(kelvin);
    // Both are fits: a hundredth of x and y is theirs together.
    EXPECT_NEAR(colour.x, right[0], 0.04 * right[0]) << kelvin;
    EXPECT_NEAR(colour.y, right[1], 0.04 * right[1]) << kelvin;
    EXPECT_NEAR(colour.z, std::max(right[2], 0.0), 0.06) << kelvin;
  }
}

TEST(BlackBodyColour, HasLuminanceOneAndNoPartBelowZero) {
  Vec3d before = black_body_colour(1667);
  EXPECT_EQ(before.z, 0);
  for (double kelvin = 1700; kelvin <= 25000; kelvin += 25) {
    const Vec3d colour = black_body_colour(kelvin);
    EXPECT_NEAR(0.2126729 * colour.x + 0.7151522 * colour.y + 0.0721750 * colour.z, 1, 1e-12);
    EXPECT_GE(colour.z, 0);
    EXPECT_LT(colour.x, before.x);  // ever less red, and bluer
    EXPECT_GE(colour.z, before.z);
    before = colour;
  }
}

}  // namespace
}  // namespace ds
