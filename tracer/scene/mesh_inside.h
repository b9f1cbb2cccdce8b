// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/mesh_topology.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ds {

/// Tells what lies inside a closed surface. `positions`, `all` and `triangles` (numbers in `all`,
/// one at least) must outlive it.
class MeshInside {
 public:
  MeshInside(std::span<const Vec3d> positions, std::span<const Triangle> all,
             std::span<const std::uint32_t> triangles);

  /// Whether another surface lies inside, of two that do not cross: within the bounds, and of three
  /// places on it two at least are inside, which outvotes one where the surfaces touch.
  bool holds(const MeshInside& other);

  /// Whether `p` is inside: a ray upwards from there passes the surface an odd number of times,
  /// however it is wound. Where it meets an edge or a corner it passes one of the triangles there,
  /// as the edge's sides are told alike for both.
  bool holds(Vec3d p);

 private:
  void sort_into_rows();
  std::size_t row_of(double y) const;
  Vec3d centre_of(std::uint32_t triangle) const;

  std::span<const Vec3d> positions_;
  std::span<const Triangle> all_;
  std::span<const std::uint32_t> triangles_;
  Vec3d least_, most_;
  // Triangles by rows of y, so that a ray looks at few of them; made when first asked.
  std::vector<std::uint32_t> row_starts_, row_triangles_;
};

}  // namespace ds
