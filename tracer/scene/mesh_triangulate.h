// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace ds {

/// Cuts polygons into triangles. Holds the work space, so that many polygons cost no allocations.
///
/// A polygon is seen along the greatest axis of its area vector (Newell's; the normal of its
/// best-fit plane), which keeps the file's coordinates exact. A strictly convex one becomes a fan
/// from its first corner. Any other loses one ear after another: first ears whose triangle, border
/// included, holds no other corner; where none is left (touching or crossing edges) those whose
/// inside holds none; at last any corner. So n corners give n - 2 triangles in the polygon's
/// winding, whatever its shape, and equal input gives equal output. Triangles without area occur
/// where the polygon leaves no choice.
class Triangulator {
 public:
  /// Appends the triangles of `polygon` (indices into `positions`, at least 3, all finite) to
  /// `out`.
  void triangulate(std::span<const Vec3d> positions, std::span<const std::uint32_t> polygon,
                   std::vector<std::array<std::uint32_t, 3>>& out);

 private:
  using Corner = std::uint32_t;  ///< position in the polygon
  struct Point {
    double x = 0, y = 0;
    bool operator==(const Point&) const = default;
  };

  bool project(std::span<const Vec3d> positions, std::span<const std::uint32_t> polygon);
  bool is_strictly_convex() const;
  void build_grid();
  std::size_t cell_of(double value, double least, double cells_per_unit) const;
  void clip_ears(std::vector<std::array<Corner, 3>>& out);
  bool is_ear(Corner corner, int strictness) const;
  bool blocks(Corner corner, Point a, Point b, Point c, int strictness) const;
  void update_reflex(Corner corner);
  static double turn(Point a, Point b, Point c);

  std::vector<Point> points_;
  std::vector<Corner> next_, previous_;
  std::vector<char> may_block_;  ///< still there and not strictly convex
  // Corners by cell of a square grid: near an ear only few need a look.
  std::vector<std::uint32_t> cell_starts_;
  std::vector<Corner> cell_corners_;
  std::size_t grid_side_ = 1;
  Point grid_least_, grid_cells_per_unit_;
  std::vector<std::array<Corner, 3>> local_;
};

}  // namespace ds
