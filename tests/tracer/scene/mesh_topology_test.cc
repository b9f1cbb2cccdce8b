// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_topology.h"

#include <gtest/gtest.h>

#include <map>

namespace ds {
namespace {

TEST(FirstEqual, AgreesWithAMap) {
  std::vector<std::array<std::uint32_t, 3>> keys;
  std::uint32_t state = 7;
  for (int i = 0; i < 20000; ++i) {
    state = state * 1664525U + 1013904223U;
    keys.push_back({(state >> 28U), (state >> 24U) & 15U, (state >> 20U) & 15U});
  }
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> seen;
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < keys.size(); ++i)
    expected.push_back(seen.emplace(keys[i], i).first->second);
  EXPECT_EQ(first_equal<3>(keys), expected);
  EXPECT_TRUE(first_equal<3>(std::span<const std::array<std::uint32_t, 3>>{}).empty());
}

TEST(Weld, JoinsEqualPlacesOnly) {
  const std::vector<Vec3d> positions{{0, 0, 0},     {1, 0, 0}, {-0.0, 0, -0.0},
                                     {1, 0, 1e-30}, {1, 0, 0}, {1 + 1e-15, 0, 0}};
  EXPECT_EQ(weld(positions), (std::vector<std::uint32_t>{0, 1, 0, 3, 1, 5}));
}

TEST(GroupEdges, FindsEachEdgeOnce) {
  const std::vector<Triangle> triangles{{0, 1, 2}, {2, 1, 3}, {1, 2, 4}};
  const std::vector<std::uint32_t> at{0, 1, 2, 3, 4};
  std::vector<std::vector<std::uint32_t>> groups;
  group_edges(triangles, at).for_each([&](std::span<const std::uint32_t> edge) {
    groups.emplace_back(edge.begin(), edge.end());
  });
  // 0-1, 0-2, 1-2 (three triangles), 1-3, 1-4, 2-3, 2-4.
  EXPECT_EQ(groups,
            (std::vector<std::vector<std::uint32_t>>{{0}, {2}, {1, 3, 6}, {4}, {8}, {5}, {7}}));
}

TEST(DisjointSets, KeepsSidesThroughLongChains) {
  DisjointSets sets(1000);
  for (std::uint32_t i = 999; i > 0; --i)
    sets.join(i, i - 1, i % 3 == 0);
  std::uint32_t side = 0;
  const std::uint32_t root = sets.find(0).root, first_side = sets.find(0).side;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    if (i > 0 && i % 3 == 0) side ^= 1U;
    EXPECT_EQ(sets.find(i).root, root);
    EXPECT_EQ(sets.find(i).side ^ first_side, side);
  }
}

}  // namespace
}  // namespace ds
