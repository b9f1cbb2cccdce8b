// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace ds {

/// The tree as the kernels read it (layout: tracer/kernels/scene_data.h).
struct Bvh {
  std::vector<float> nodes;   ///< k_node_vectors * 8 floats a node; node 0 is the root
  std::vector<float> leaves;  ///< k_leaf_vectors * 8 words a leaf
};

/// A tree, and how many levels of nodes it has.
struct WideTree {
  Bvh bvh;
  unsigned levels = 0;
};

enum class BvhQuality { low, medium, high };

inline constexpr int k_least_bvh_width = 2, k_most_bvh_width = 8;

/// Builds the tree over triangles given by their corners; a triangle's id is its index. At least
/// one triangle; all coordinates finite and at most 1e18 in size. A node has at most `width`
/// children, k_least_bvh_width to k_most_bvh_width; its layout is of eight, and leaves hold up to
/// eight triangles, whatever the width. Quality and width change the speed of rays, never what they
/// hit. Throws Error(device) where Embree fails or the tree is deeper than the kernels' stack
/// allows (k_bvh_depth of kernels/scene_data.h), which a narrow one is sooner.
Bvh build_bvh(std::span<const std::array<Vec3, 3>> triangles,
              BvhQuality quality = BvhQuality::medium, int width = k_most_bvh_width);
WideTree build_wide_tree(std::span<const std::array<Vec3, 3>> triangles, BvhQuality quality,
                         int width);

class TreeCache;

/// The same tree of triangles that come from two places, the first `first_count` from one: trees of
/// each, from the cache, are joined, which is quicker where one of them is known and gives a tree
/// that rays pass about as quickly. One tree where either has none.
Bvh build_joined_bvh(std::span<const std::array<Vec3, 3>> triangles, std::size_t first_count,
                     BvhQuality quality, int width, TreeCache& cache);

}  // namespace ds
