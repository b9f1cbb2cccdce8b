// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/geometry_errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ds {
namespace {

/// A slanted edge: the model covers what lies left of x = 1.25 + y / 4 (pixels of a 4x4 picture),
/// at 2 m, before a wall at 4 m.
Geometry slanted(int factor) {
  Geometry geometry{4 * factor, 4 * factor, {}, {}};
  for (int y = 0; y < geometry.height; ++y)
    for (int x = 0; x < geometry.width; ++x) {
      const double px = (x + 0.5) / factor;
      const double py = (y + 0.5) / factor;
      const bool model = px < 1.25 + py / 4;
      geometry.mask.push_back(model ? 255 : 0);
      geometry.depth.push_back(model ? 2.0f : 4.0f);
    }
  return geometry;
}

TEST(GeometryErrors, CoverageIsTheArea) {
  const Coverage fine = coverage_of(slanted(64), 64);
  ASSERT_EQ(fine.width, 4);
  double area = 0;
  for (const float share : fine.model)
    area += double{share};
  // The integral of 1.25 + y / 4 from 0 to 4.
  EXPECT_NEAR(area, 7, 0.02);
  EXPECT_EQ(fine.hits[0], 1);
  // Row 0: a trapezium of mean width 1.375; pixel 1 shows 0.375 of the model.
  EXPECT_NEAR(double{fine.model[1]}, 0.375, 0.01);
  EXPECT_NEAR(double{fine.depth[1]}, 0.375 * 2 + 0.625 * 4, 0.02);
}

TEST(GeometryErrors, OneRayAPixelMissesTheRest) {
  const Coverage one = coverage_of(slanted(1), 1);
  const Coverage fine = coverage_of(slanted(64), 64);
  const GeometryErrors errors = geometry_errors(one, fine);
  // Rows have edges from 1.25 to 1.5, to 1.75, to 2 and to 2.25: the pixels they cross show 0.375,
  // 0.625, 0.875 and 0.125 of the model, their centres nothing, all, all and nothing.
  const double wrong[] = {0.375, 1 - 0.625, 1 - 0.875, 0.125};
  double squares = 0;
  for (const double w : wrong)
    squares += w * w;
  EXPECT_NEAR(errors.mask_rms, std::sqrt(squares / 16), 0.005);
  EXPECT_EQ(errors.mask_wrong, 0);
  EXPECT_GT(errors.depth_rms, 0);
  const GeometryErrors none = geometry_errors(fine, fine);
  EXPECT_EQ(none.mask_rms, 0);
  EXPECT_EQ(none.depth_rms, 0);
}

TEST(GeometryErrors, WhatIsNotHitHasNoDepth) {
  Geometry empty{2, 2, std::vector<std::uint8_t>(4), std::vector<float>(4)};
  const Coverage coverage = coverage_of(empty, 2);
  EXPECT_EQ(coverage.depth[0], 0);
  EXPECT_EQ(geometry_errors(coverage, coverage).depth_rms, 0);
}

}  // namespace
}  // namespace ds
