// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/accel/bvh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace ds {

/// An axis-aligned box; empty where low is above high.
struct NodeBox {
  std::array<float, 3> low, high;
  /// Half its surface: what a random ray's chance of meeting it is proportional to.
  float half_area() const {
    const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x * y + y * z + z * x;
  }
};

/// A node of a tree whose leaves hold one triangle each.
struct BinaryNode {
  NodeBox bounds;
  std::uint32_t left = 0, right = 0;  ///< places in the tree; of a leaf both are its own place
  std::uint32_t triangle = 0;         ///< of a leaf
  std::uint32_t leaf_count = 1;       ///< leaves below, itself counted
};

/// Embree's tree over the triangles: children stand before their parent, the root is last. With
/// BvhQuality::high a triangle may stand in several leaves (spatial splits). Bounds hold what the
/// kernels' triangle test needs beside the triangle (kernels/bvh.cl). Domain and errors as
/// build_bvh's.
std::vector<BinaryNode> build_binary_tree(std::span<const std::array<Vec3, 3>> triangles,
                                          BvhQuality quality);

}  // namespace ds
