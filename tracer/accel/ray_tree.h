// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/accel/binary_tree.h"
#include "tracer/base/vec.h"

#include <array>
#include <span>
#include <vector>

namespace ds {

/// Triangles for a few thousand rays on the host, in doubles: what a plan asks of a scene before any
/// picture. Answers do not depend on the tree: the same bits on every machine.
class RayTree {
 public:
  RayTree() = default;
  /// Domain as build_bvh's, but that there may be none.
  explicit RayTree(std::vector<std::array<Vec3, 3>> triangles);

  bool empty() const { return triangles_.empty(); }
  /// The least t in (0, most) at which origin + t direction meets a triangle from either side; `most` where it meets
  /// none. The direction need not be of unit length.
  double nearest(Vec3d origin, Vec3d direction, double most) const;
  /// How many triangles the ray meets.
  int crossings(Vec3d origin, Vec3d direction) const;
  /// How far the nearest point of the triangles is; `most` where none is nearer.
  double distance(Vec3d from, double most) const;

 private:
  template <typename Enter, typename Bound, typename Meet>
  void walk(const Enter& enter, const Bound& bound, const Meet& meet) const;

  std::vector<std::array<Vec3, 3>> triangles_;
  std::vector<BinaryNode> nodes_;  ///< the last is the root
};

}  // namespace ds
