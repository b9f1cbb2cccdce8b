// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>

namespace ds {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

std::vector<std::uint32_t> in_order(std::size_t n) {
  std::vector<std::uint32_t> polygon(n);
  std::iota(polygon.begin(), polygon.end(), 0U);
  return polygon;
}

Triangles cut(const std::vector<Vec3d>& positions) {
  Triangles out;
  EXPECT_TRUE(Triangulator().triangulate(positions, in_order(positions.size()), out));
  EXPECT_EQ(out.size(), positions.size() - 2);
  return out;
}

double area_z(const std::vector<Vec3d>& p, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  return cross(p[b] - p[a], p[c] - p[a]).z / 2;
}

/// The shoelace formula: independent of any triangulation.
double shoelace(const std::vector<Vec3d>& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec3d a = p[i], b = p[(i + 1) % p.size()];
    sum += a.x * b.y - b.x * a.y;
  }
  return sum / 2;
}

/// All triangles wound as the polygon and none overlapping: with areas of one sign, their sum is
/// the polygon's only if they cover it once.
void expect_covers(const std::vector<Vec3d>& polygon, const Triangles& triangles,
                   bool strictly = true) {
  double sum = 0;
  const double whole = shoelace(polygon);
  const double sign = whole > 0 ? 1 : -1;
  for (const auto& [a, b, c] : triangles) {
    const double area = sign * area_z(polygon, a, b, c);
    if (strictly)
      EXPECT_GT(area, 0);
    else
      EXPECT_GE(area, 0);
    sum += area;
  }
  EXPECT_NEAR(sum, std::fabs(whole), 1e-9 * std::fabs(whole));
}

TEST(Triangulator, ConvexIsAFan) {
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Triangulator, CutsADartAtItsReflexCorner) {
  // For both places of the reflex corner; the wrong diagonal would lie outside.
  const std::vector<Vec3d> dart{{0, 0, 0}, {4, 4, 0}, {0, 1, 0}, {-4, 4, 0}};
  expect_covers(dart, cut(dart));
  const std::vector<Vec3d> turned{{4, 4, 0}, {0, 1, 0}, {-4, 4, 0}, {0, 0, 0}};
  expect_covers(turned, cut(turned));
}

TEST(Triangulator, KeepsTheWindingSeenFromAnySide) {
  const std::vector<Vec3d> ell{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  const auto swapped = [&](auto map) {
    std::vector<Vec3d> out;
    for (const Vec3d p : ell)
      out.push_back(map(p));
    return out;
  };
  const Triangles expected = cut(ell);
  expect_covers(ell, expected);
  // Rotations of the plane leave the choice of ears alone.
  EXPECT_EQ(cut(swapped([](Vec3d p) { return Vec3d{p.z, p.x, p.y}; })), expected);
  EXPECT_EQ(cut(swapped([](Vec3d p) { return Vec3d{p.y, p.z, p.x}; })), expected);
  EXPECT_EQ(cut(swapped([](Vec3d p) { return Vec3d{p.x, -p.y, -p.z}; })), expected);
  const auto mirrored = swapped([](Vec3d p) { return Vec3d{-p.x, p.y, p.z}; });
  expect_covers(mirrored, cut(mirrored));
}

TEST(Triangulator, CornersOnALineGiveNoEmptyTriangle) {
  const std::vector<Vec3d> square{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0},
                                  {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
  for (std::size_t shift = 0; shift < square.size(); ++shift) {
    std::vector<Vec3d> turned(square);
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(shift), turned.end());
    expect_covers(turned, cut(turned));
  }
}

TEST(Triangulator, CutsAroundAHoleWithASlit) {
  const std::vector<Vec3d> ring{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                                {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
  EXPECT_EQ(shoelace(ring), 12);
  expect_covers(ring, cut(ring));
}

std::vector<Vec3d> star(std::size_t corners, double inner) {
  std::vector<Vec3d> out;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle =
        2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
    const double radius = i % 2 ? inner : 1.0;
    out.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  return out;
}

TEST(Triangulator, StarsOfAnySize) {
  for (const std::size_t n : {6U, 10U, 50U, 1000U, 20000U}) {
    const std::vector<Vec3d> polygon = star(n, 0.9);
    expect_covers(polygon, cut(polygon));
  }
}

TEST(Triangulator, ACombOfTwentyThousandTeethIsQuick) {
  std::vector<Vec3d> comb{{0, -1, 0}};
  for (int i = 0; i < 20000; ++i) {
    const auto x = static_cast<float>(i);
    comb.push_back({20000 - x, i % 2 ? 1.0F : 0.0F, 0});
  }
  for (Vec3d& p : comb)
    p.x *= -1;
  expect_covers(comb, cut(comb), false);
}

TEST(Triangulator, ASpiralIsCovered) {
  std::vector<Vec3d> spiral;
  constexpr int k_steps = 400;
  const auto at = [](int i, double gap) {
    const double angle = 0.1 * i, radius = 1 + 0.1 * angle + gap;
    return Vec3d{radius * std::cos(angle), radius * std::sin(angle), 0};
  };
  for (int i = 0; i < k_steps; ++i)
    spiral.push_back(at(i, 0));
  for (int i = k_steps - 1; i >= 0; --i)
    spiral.push_back(at(i, -0.2));
  expect_covers(spiral, cut(spiral));
}

TEST(Triangulator, DegenerateOnesEnd) {
  cut(std::vector<Vec3d>(5, {1, 1, 1}));
  cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}});
  cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});  // a bow tie
  cut({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}});  // a spike
  cut({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}});
  cut({{-1e18F, 0, 0}, {1e18F, 0, 0}, {0, 1e-38F, 0}, {0, 1e18F, 1}});
  std::vector<Vec3d> pentagram;
  for (int i = 0; i < 5; ++i)
    pentagram.push_back(
        {std::cos(4 * std::numbers::pi / 5 * i), std::sin(4 * std::numbers::pi / 5 * i), 0});
  cut(pentagram);
}

TEST(Triangulator, ScribblesEndSoon) {
  // A fixed sequence of "random" corners: crossing itself everywhere.
  std::uint64_t state = 1;
  const auto next = [&] {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<float>(state >> 40U) / 16777216.0F;
  };
  std::vector<Vec3d> scribble;
  for (int i = 0; i < 5000; ++i)
    scribble.push_back({next(), next(), next()});
  EXPECT_EQ(cut(scribble), cut(scribble));
}

/// From whichever corner it is written.
void expect_covers_from_each_corner(std::vector<Vec3d> polygon) {
  for (std::size_t first = 0; first < polygon.size(); ++first) {
    SCOPED_TRACE(first);
    expect_covers(polygon, cut(polygon), false);
    std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
  }
}

TEST(Triangulator, CoversPolygonsThatTouchThemselvesInACorner) {
  // Two squares, three squares about one corner, and a hole that touches the outline.
  expect_covers_from_each_corner(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}});
  expect_covers_from_each_corner({{0, 0, 0},
                                  {1, 0, 0},
                                  {1, 1, 0},
                                  {1, 0.5, 0},
                                  {2, 0.5, 0},
                                  {2, 1, 0},
                                  {1, 1, 0},
                                  {2, 1.5, 0},
                                  {2, 2, 0},
                                  {1, 2, 0},
                                  {1, 1, 0},
                                  {0, 1, 0}});
  expect_covers_from_each_corner(
      {{0, 0, 0}, {6, 0, 0}, {6, 6, 0}, {3, 6, 0}, {2, 3, 0}, {4, 3, 0}, {3, 6, 0}, {0, 6, 0}});
}

TEST(Triangulator, CoversPolygonsWithCornersTwiceAndSpikes) {
  std::vector<Vec3d> twice;
  for (const Vec3d p : {Vec3d{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 2, 0}, {2, 4, 0}, {0, 4, 0}})
    twice.insert(twice.end(), 2, p);
  expect_covers_from_each_corner(twice);
  // A spike without width on the outside of an L, and one from each of three sides of a square.
  expect_covers_from_each_corner({{0, 0, 0},
                                  {4, 0, 0},
                                  {4, 1, 0},
                                  {7, 1, 0},
                                  {4, 1, 0},
                                  {4, 2, 0},
                                  {2, 2, 0},
                                  {2, 4, 0},
                                  {0, 4, 0}});
  expect_covers_from_each_corner({{0, 0, 0},
                                  {2, 0, 0},
                                  {2, -3, 0},
                                  {2, 0, 0},
                                  {4, 0, 0},
                                  {4, 2, 0},
                                  {7, 2, 0},
                                  {4, 2, 0},
                                  {4, 4, 0},
                                  {2, 4, 0},
                                  {2, 7, 0},
                                  {2, 4, 0},
                                  {0, 4, 0}});
}

TEST(Triangulator, RefusesWhatWouldTakeMinutes) {
  std::vector<Vec3d> comb{{0, -1, 0}};
  for (int tooth = 0; tooth < 300'000; ++tooth) {
    comb.push_back({2.0 * tooth, 0, 0});
    comb.push_back({2.0 * tooth + 1, 1, 0});
  }
  std::reverse(comb.begin() + 1, comb.end());
  Triangles out;
  EXPECT_FALSE(Triangulator().triangulate(comb, in_order(comb.size()), out));
  EXPECT_TRUE(out.empty());
}

TEST(Triangulator, ManyCornersInOnePlaceTakeNoTime) {
  std::vector<Vec3d> polygon{{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}};
  polygon.insert(polygon.begin() + 1, 200'000, {4, 0, 0});
  expect_covers(polygon, cut(polygon), false);
}

}  // namespace
}  // namespace ds
