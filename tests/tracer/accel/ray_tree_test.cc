// SPDX-License-Identifier: Apache-2.0
#include "tracer/accel/ray_tree.h"

#include "tracer/scene/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace ds {
namespace {

using Corners = std::array<Vec3, 3>;

std::vector<Corners> teapot() {
  const Mesh mesh = normalise(read_model(DS_SOURCE_DIR "/assets/models/teapot-1.ply").mesh, {});
  std::vector<Corners> triangles;
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
  return triangles;
}

/// By the plane and three half planes, at every triangle in turn; negative where it is missed.
double met_by_planes(const Corners& triangle, Vec3d origin, Vec3d direction) {
  const Vec3d a = to_double(triangle[0]), b = to_double(triangle[1]), c = to_double(triangle[2]);
  const Vec3d normal = cross(b - a, c - a);
  const double t = dot(a - origin, normal) / dot(direction, normal);
  const Vec3d p = origin + direction * t;
  const bool inside = dot(cross(b - a, p - a), normal) >= 0 &&
                      dot(cross(c - b, p - b), normal) >= 0 &&
                      dot(cross(a - c, p - c), normal) >= 0;
  return inside ? t : -1;
}

TEST(RayTree, FindsWhatEveryTriangleInTurnGives) {
  const std::vector<Corners> triangles = teapot();
  const RayTree tree(triangles);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> even(-0.1, 0.1);
  int hits = 0;
  for (int i = 0; i < 1200; ++i) {
    const Vec3d origin{even(random), even(random), even(random)},
        direction{even(random), even(random), even(random)};
    double least = 100;
    int count = 0;
    for (const Corners& triangle : triangles) {
      const double t = met_by_planes(triangle, origin, direction);
      if (t <= 0) continue;
      least = std::min(least, t);
      ++count;
    }
    EXPECT_NEAR(tree.nearest(origin, direction, 100), least, 1e-9 * least);
    EXPECT_EQ(tree.crossings(origin, direction), count);
    EXPECT_EQ(tree.nearest(origin, direction, least / 2), least / 2);
    hits += count > 0;
  }
  EXPECT_GT(hits, 100);
}

TEST(RayTree, TheNearestPointIsThatOfDenseSamples) {
  const std::vector<Corners> triangles = teapot();
  const RayTree tree(triangles);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> even(-0.15, 0.15);
  for (int i = 0; i < 40; ++i) {
    const Vec3d from{even(random), even(random), even(random)};
    // No sample is nearer, and one is about as near: triangles are some millimetres wide.
    double sampled = 1;
    constexpr int k_steps = 8;
    for (const Corners& triangle : triangles)
      for (int u = 0; u <= k_steps; ++u)
        for (int v = 0; u + v <= k_steps; ++v) {
          const Vec3d a = to_double(triangle[0]), b = to_double(triangle[1]),
                      c = to_double(triangle[2]);
          const Vec3d p = a + (b - a) * (double(u) / k_steps) + (c - a) * (double(v) / k_steps);
          sampled = std::min(sampled, length(p - from));
        }
    const double distance = tree.distance(from, 1);
    EXPECT_LE(distance, sampled + 1e-12);
    EXPECT_GT(distance, sampled - 2e-3);
    EXPECT_EQ(tree.distance(from, distance / 2), distance / 2);
  }
}

TEST(RayTree, OfNothingIsMetByNothing) {
  const RayTree tree;
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.nearest({}, {1, 0, 0}, 5), 5);
  EXPECT_EQ(tree.crossings({}, {1, 0, 0}), 0);
  EXPECT_EQ(tree.distance({}, 5), 5);
}

}  // namespace
}  // namespace ds
