// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ds {
namespace {

TEST(AngleBetween, IsThatOfTheLibraryWithinAFewUlps) {
  for (int i = 0; i <= 200000; ++i) {
    const double angle = std::numbers::pi * i / 200000;
    const double scale = std::pow(10.0, i % 40 - 20);
    const double s = std::fabs(std::sin(angle)) * scale, c = std::cos(angle) * scale;
    ASSERT_NEAR(angle_between(s, c), std::atan2(s, c), 1e-15) << i;
  }
}

TEST(AngleBetween, HoldsAtTheEdgesOfItsDomain) {
  EXPECT_EQ(angle_between(0, 0), 0);
  EXPECT_EQ(angle_between(0, 1), 0);
  EXPECT_EQ(angle_between(0, -1), std::numbers::pi);
  EXPECT_EQ(angle_between(1, 0), std::numbers::pi / 2);
  EXPECT_NEAR(angle_between(1e-300, 1e-300), std::numbers::pi / 4, 1e-15);
}

TEST(CosineDeg, IsThatOfTheLibraryWithinAFewUlps) {
  for (int i = 0; i <= 18000; ++i)
    ASSERT_NEAR(cosine_deg(i / 100.0), std::cos(i / 100.0 / 180 * std::numbers::pi), 1e-15) << i;
  EXPECT_EQ(cosine_deg(0), 1);
  EXPECT_EQ(cosine_deg(90), 0);
  EXPECT_EQ(cosine_deg(180), -1);
}

struct Surface {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> welded;
};

void finish(Surface& s) {
  std::vector<Vec3d> rounded;
  for (const Vec3d p : s.positions)
    rounded.push_back(to_double(to_float(p)));
  s.welded = weld(rounded);
}

/// Two triangles over the edge from (0,0,0) to (0,1,0), the second bent by `angle_deg` from flat.
Surface hinge(double angle_deg, bool wound_alike) {
  const double angle = angle_deg / 180 * std::numbers::pi;
  Surface s;
  s.positions = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {std::cos(angle), 0, std::sin(angle)}};
  s.triangles = {{0, 1, 2}, {1, 0, 3}};
  if (!wound_alike) s.triangles[1] = {0, 1, 3};
  finish(s);
  return s;
}

double angle_deg(Vec3d a, Vec3d b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

TEST(SmoothNormals, JoinUpToTheCreaseAndSplitBeyond) {
  const Surface below = hinge(59.9, true), above = hinge(60.1, true);
  const auto joined = smooth_corner_normals(below.positions, below.triangles, below.welded, 60);
  EXPECT_EQ(joined[0], joined[4]);
  EXPECT_EQ(joined[1], joined[3]);
  // Of equal area and angle at vertex 0: half-way between.
  EXPECT_NEAR(angle_deg(joined[0], joined[2]), 59.9 / 2, 1e-9);
  const auto split = smooth_corner_normals(above.positions, above.triangles, above.welded, 60);
  EXPECT_NEAR(angle_deg(split[0], split[4]), 60.1, 1e-9);
  EXPECT_EQ(split[0], split[2]);
}

TEST(SmoothNormals, TheCreaseItselfIsSmooth) {
  const Surface s = hinge(90, true);
  const auto normals = smooth_corner_normals(s.positions, s.triangles, s.welded, 90);
  EXPECT_EQ(normals[0], normals[4]);
}

TEST(SmoothNormals, NeighboursWoundAgainstEachOtherDoNotMix) {
  // Flat, but the second faces down; and folded back, so that both normals agree.
  for (const double bend : {0.0, 20.0, 170.0, 179.0}) {
    const Surface s = hinge(bend, false);
    const auto faces = face_normals(s.positions, s.triangles);
    const auto normals = smooth_corner_normals(s.positions, s.triangles, s.welded, 60);
    for (std::size_t c = 0; c < 6; ++c)
      EXPECT_LT(length(normals[c] - faces[c / 3]), 1e-15) << bend;
  }
}

TEST(SmoothNormals, WeightByAreaAndAngle) {
  // A flat triangle of area 2 and a right angle, and one bent up of area 1/2 and 45 degrees.
  Surface s;
  s.positions = {{0, 0, 0},
                 {0, 2, 0},
                 {-2, 0, 0},
                 {1 / std::numbers::sqrt2 * 0.5, 1, 0.5 / std::numbers::sqrt2}};
  s.triangles = {{0, 1, 2}, {1, 0, 3}};
  finish(s);
  const Vec3d n0{0, 0, 1};
  const Vec3d n1 =
      normalized(cross(s.positions[0] - s.positions[1], s.positions[3] - s.positions[1]));
  const double area1 =
      length(cross(s.positions[0] - s.positions[1], s.positions[3] - s.positions[1])) / 2;
  const double angle1 = std::acos(dot(normalized(s.positions[1]), normalized(s.positions[3])));
  const Vec3d expected = normalized(n0 * (2 * std::numbers::pi / 2) + n1 * (area1 * angle1));
  const auto normals = smooth_corner_normals(s.positions, s.triangles, s.welded, 60);
  EXPECT_LT(length(normals[0] - expected), 1e-14);
}

/// A cone of `sides` triangles with its tip at (0, 0, height), without a base.
Surface cone(std::uint32_t sides, double height) {
  Surface s;
  s.positions.push_back({0, 0, height});
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    s.positions.push_back({std::cos(angle), std::sin(angle), 0});
    s.triangles.push_back({0, i + 1, (i + 1) % sides + 1});
  }
  finish(s);
  return s;
}

TEST(SmoothNormals, TurnAroundTheTipOfACone) {
  const Surface s = cone(64, 4);
  const auto faces = face_normals(s.positions, s.triangles);
  const auto normals = smooth_corner_normals(s.positions, s.triangles, s.welded, 60);
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    EXPECT_LT(angle_deg(normals[3 * t], faces[t]), 10);
  // A flat disc shares one.
  const Surface disc = cone(64, 0);
  const auto flat = smooth_corner_normals(disc.positions, disc.triangles, disc.welded, 60);
  EXPECT_TRUE(std::all_of(flat.begin(), flat.end(), [](Vec3d n) {
    return length(n - Vec3d{0, 0, 1}) < 1e-15;
  }));
}

TEST(SmoothNormals, AHubOfManyTrianglesIsQuick) {
  const Surface s = cone(200000, 4);
  const auto faces = face_normals(s.positions, s.triangles);
  const auto normals = smooth_corner_normals(s.positions, s.triangles, s.welded, 60);
  for (std::size_t c = 0; c < normals.size(); ++c)
    ASSERT_GT(dot(normals[c], faces[c / 3]), 0);
}

TEST(SmoothNormals, NeverPointBehindTheirTriangle) {
  // A knife edge, with everything smooth.
  const Surface s = hinge(179, true);
  const auto faces = face_normals(s.positions, s.triangles);
  const auto normals = smooth_corner_normals(s.positions, s.triangles, s.welded, 180);
  for (std::size_t c = 0; c < normals.size(); ++c) {
    EXPECT_GT(dot(normals[c], faces[c / 3]), 0);
    EXPECT_NEAR(length(normals[c]), 1, 1e-15);
  }
}

TEST(SmoothNormals, ATriangleWithoutAreaHasNone) {
  Surface s;
  s.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  s.triangles = {{0, 1, 2}};
  finish(s);
  EXPECT_EQ(smooth_corner_normals(s.positions, s.triangles, s.welded, 60), std::vector<Vec3d>(3));
}

}  // namespace
}  // namespace ds
