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
  const std::vector<Vec3> positions{
      {0, 0, 0}, {1, 0, 0}, {-0.0F, 0, -0.0F}, {1, 0, 1e-30F}, {1, 0, 0}};
  EXPECT_EQ(weld(positions), (std::vector<std::uint32_t>{0, 1, 0, 3, 1}));
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

TEST(CountFlipped, CountsTheMinorityOfEachComponent) {
  const std::vector<std::uint32_t> at{0, 1, 2, 3, 4, 5, 6, 7};
  const std::vector<Triangle> tetra{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  EXPECT_EQ(count_flipped(tetra, at), 0U);
  std::vector<Triangle> one_turned = tetra;
  one_turned[2] = {0, 2, 3};
  EXPECT_EQ(count_flipped(one_turned, at), 1U);
  // A second tetrahedron, wholly inside out, is its own component and right in itself.
  for (const Triangle& t : tetra)
    one_turned.push_back({t[0] + 4, t[2] + 4, t[1] + 4});
  EXPECT_EQ(count_flipped(one_turned, at), 1U);
}

TEST(CountFlipped, AMoebiusBandEnds) {
  std::vector<Triangle> band;
  std::vector<std::uint32_t> at;
  constexpr std::uint32_t k_steps = 9;
  for (std::uint32_t i = 0; i < k_steps; ++i) {
    const bool last = i + 1 == k_steps;
    const std::uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    band.push_back({a, c, b});
    band.push_back({b, c, d});
    at.insert(at.end(), {a, b});
  }
  EXPECT_LE(count_flipped(band, at), band.size() / 2);
}

}  // namespace
}  // namespace ds
