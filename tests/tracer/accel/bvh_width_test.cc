// SPDX-License-Identifier: Apache-2.0
// Trees by the most children a node may have: what nodes and leaves hold, how deep they get, and
// that the deepest is walked. What rays meet in the others: bvh_test.cc.
#include "tests/render/pictures.h"
#include "tests/tracer/accel/rays.h"
#include "tracer/accel/tree_cache.h"
#include "tracer/base/error.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

namespace ds {
namespace {

using namespace kernels;
using rays::Corners;
using rays::corners_of;

constexpr std::uint32_t k_leaf_bit = 0x80000000u;

std::vector<Corners> teapot() {
  return corners_of(in_floats(read_model(DS_SOURCE_DIR "/assets/models/teapot-1.ply").mesh));
}

struct Shape {
  std::size_t levels = 0, fewest_children = k_bvh_width, most_children = 0;
  std::vector<std::uint32_t> triangles;  ///< of all leaves, absent ones left out
};

void look(const Bvh& bvh, std::size_t node, std::size_t level, Shape& shape) {
  shape.levels = std::max(shape.levels, level);
  const float* words = bvh.nodes.data() + node * k_node_vectors * k_bvh_width;
  std::size_t children = 0;
  for (std::size_t i = 0; i < k_bvh_width; ++i) {
    if (words[i] > words[k_bvh_width + i]) continue;  // absent: inside out
    ++children;
    const auto child = std::bit_cast<std::uint32_t>(words[k_node_children * k_bvh_width + i]);
    if ((child & k_leaf_bit) == 0) {
      look(bvh, child, level + 1, shape);
      continue;
    }
    const float* leaf = bvh.leaves.data() + (child & ~k_leaf_bit) * k_leaf_vectors * k_bvh_width;
    for (std::size_t k = 0; k < k_bvh_width; ++k) {
      const auto is_zero = [&](std::size_t vector) { return leaf[vector * k_bvh_width + k] == 0; };
      bool absent = true;
      for (std::size_t vector = 0; vector < k_leaf_ids; ++vector)
        absent = absent && is_zero(vector);
      if (!absent)
        shape.triangles.push_back(std::bit_cast<std::uint32_t>(leaf[k_leaf_ids * k_bvh_width + k]));
    }
  }
  shape.fewest_children = std::min(shape.fewest_children, children);
  shape.most_children = std::max(shape.most_children, children);
}

Shape shape_of(const Bvh& bvh) {
  Shape shape;
  look(bvh, 0, 1, shape);
  std::sort(shape.triangles.begin(), shape.triangles.end());
  return shape;
}

class BvhWidth : public testing::TestWithParam<int> {};

TEST_P(BvhWidth, IsTheMostChildrenOfANode) {
  const std::vector<Corners> triangles = teapot();
  std::vector<std::uint32_t> all(triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  for (const BvhQuality quality : {BvhQuality::low, BvhQuality::medium, BvhQuality::high}) {
    Shape shape = shape_of(build_bvh(triangles, quality, GetParam()));
    EXPECT_GE(shape.fewest_children, 2u);
    // Of a mesh of thousands some node takes all that it may.
    EXPECT_EQ(shape.most_children, static_cast<std::size_t>(GetParam()));
    // Spatial splits put a triangle into several leaves.
    const auto end = std::unique(shape.triangles.begin(), shape.triangles.end());
    if (quality != BvhQuality::high) {
      EXPECT_EQ(end, shape.triangles.end());
    }
    shape.triangles.erase(end, shape.triangles.end());
    EXPECT_EQ(shape.triangles, all);
  }
}

TEST_P(BvhWidth, LeavesAMillionTrianglesWithinTheKernelsDepth) {
  const Shape shape = shape_of(build_bvh(corners_of(pictures::sphere({0, 0, 0}, 1, 512, false)),
                                         BvhQuality::medium, GetParam()));
  EXPECT_GE(shape.triangles.size(), 1000000u);
  EXPECT_LE(shape.levels, std::size_t{k_bvh_depth});
}

/// A model in an empty room and in one that is as full as the model; a room in a model.
TEST_P(BvhWidth, HoldsWhereTreesAreJoined) {
  const std::vector<Corners> model = teapot();
  const std::vector<Corners> ball = corners_of(pictures::sphere({0, 0, 0}, 3, 24, false));
  const std::vector<Corners> box = corners_of(pictures::box({0, 0, 0}, {1, 1, 1}));
  TreeCache cache(std::size_t{1} << 28U);
  for (const auto& [first, second] :
       {std::pair(box, model), std::pair(ball, model), std::pair(model, box)}) {
    std::vector<Corners> both = first;
    both.insert(both.end(), second.begin(), second.end());
    std::vector<std::uint32_t> all(both.size());
    std::iota(all.begin(), all.end(), 0u);
    const Shape shape =
        shape_of(build_joined_bvh(both, first.size(), BvhQuality::medium, GetParam(), cache));
    EXPECT_EQ(shape.triangles, all);
    EXPECT_LE(shape.most_children, static_cast<std::size_t>(GetParam()));
    EXPECT_LE(shape.levels, std::size_t{k_bvh_depth});
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, BvhWidth, testing::Values(2, 3, 4, 8));

/// Axis i % 3, across which triangle i of `dwindling` stands, and its distance from the origin.
Vec3 axis_of(std::size_t i) {
  return {i % 3 == 0 ? 1.0f : 0.0f, i % 3 == 1 ? 1.0f : 0.0f, i % 3 == 2 ? 1.0f : 0.0f};
}
float distance_of(std::size_t i) {
  return std::ldexp(1.0f, 20 - static_cast<int>(i));
}

/// Each half as large as the one before and half as far from the origin, along x, y and z by turns.
/// A split by cost takes the farthest off alone, until eight are left that make a leaf.
std::vector<Corners> dwindling(std::size_t count) {
  std::vector<Corners> triangles;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 a = axis_of(i), b = axis_of(i + 1) * 0.25f, c = axis_of(i + 2) * 0.25f;
    const float s = distance_of(i);
    triangles.push_back({(a - b - c) * s, (a + b - c) * s, (a + c) * s});
  }
  return triangles;
}
/// As many of them as fit into the deepest tree of width 2.
constexpr std::size_t k_most_dwindling = k_bvh_depth + 8;

TEST(BvhDepth, IsHeldToWhatTheKernelsCanWalk) {
  const auto levels = [](std::size_t count, int width) {
    return shape_of(build_bvh(dwindling(count), BvhQuality::medium, width)).levels;
  };
  EXPECT_EQ(levels(k_most_dwindling, 2), std::size_t{k_bvh_depth});
  try {
    levels(k_most_dwindling + 1, 2);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::device);
    EXPECT_STREQ(error.what(), "the scene's tree has more than 32 levels");
  }
  // More children a node take more triangles off a level.
  EXPECT_LT(levels(k_most_dwindling + 1, 4), std::size_t{k_bvh_depth});
}

TEST(BvhDepth, OfAsManyLevelsAsThereMayBeIsWalked) {
  const std::vector<Corners> triangles = dwindling(k_most_dwindling);
  // Along an axis from between two of its triangles, to the nearer one and to the farther one.
  std::vector<rays::TestRay> all;
  std::vector<std::uint32_t> wanted;
  for (std::uint32_t i = 3; i < triangles.size(); ++i)
    for (const float towards : {-1.0f, 1.0f}) {
      all.push_back({axis_of(i) * (3 * distance_of(i)), axis_of(i) * towards});
      wanted.push_back(towards < 0 ? i : i - 3);
    }
  const rays::Tree tree(triangles, BvhQuality::medium, 2);
  const std::vector<rays::TestHit> single = tree.nearest(all);
  const rays::Tree::Batched batched = tree.batched(all, 16);
  const std::vector<std::uint32_t> any = tree.any(all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(single[i].id, wanted[i]) << i;
    EXPECT_EQ(batched.nearest[i].id, wanted[i]) << i;
    EXPECT_FLOAT_EQ(single[i].t, std::fabs(distance_of(wanted[i]) - length(all[i].origin))) << i;
    EXPECT_TRUE(any[i] != 0 && batched.any[i] != 0) << i;
  }
}

/// What a tracer whose nodes have at most `width` children answers of a scene too deep for two;
/// empty where it traces it.
std::string refusal(int width, bool geometry) {
  Mesh mesh;
  for (const Corners& corners : dwindling(k_most_dwindling + 1)) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  Scene scene;
  pictures::add_object(scene, mesh, pictures::add_matte(scene, {1, 1, 1}));
  scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  TracerOptions options = pictures::tracer_options();
  options.bvh_width = width;
  Tracer tracer(options);
  tracer.set_scene(scene);
  EngineSettings engine;
  engine.width = engine.height = 4;
  engine.spp = 1;
  try {
    if (geometry)
      tracer.trace_geometry(Camera{}, 4, 4);
    else
      tracer.trace(Camera{}, engine);
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(BvhDepth, FollowsFromTheTracersOption) {
  for (const bool geometry : {false, true}) {
    EXPECT_EQ(refusal(2, geometry), "the scene's tree has more than 32 levels");
    EXPECT_EQ(refusal(4, geometry), "");
  }
}

}  // namespace
}  // namespace ds
