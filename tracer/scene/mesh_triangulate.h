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
/// from its first corner. Any other loses one ear after another: corners where the way goes straight
/// back or stays (spikes) as soon as there are any; then ears whose triangle, border included, holds no
/// other corner; where none is left, corners on an edge, ears whose inside holds no corner (touching or
/// crossing edges), and at last any. So n corners give n - 2
/// triangles in the polygon's winding, whatever its shape, and equal input gives equal output.
/// Triangles without area occur where the polygon leaves no choice.
class Triangulator {
 public:
  /// How many corners may be looked at for one polygon, which is some seconds: a circle's million corners
  /// take few looks each, a comb's teeth all of them.
  static constexpr std::uint64_t k_most_looks = 1'000'000'000;

  /// Appends the triangles of `polygon` (indices into `positions`, at least 3, all finite) to
  /// `out`. False, and nothing done, where it would take too long.
  bool triangulate(std::span<const Vec3d> positions, std::span<const std::uint32_t> polygon,
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
  bool clip_ears(std::vector<std::array<Corner, 3>>& out);
  bool is_ear(Corner corner, int strictness) const;
  bool blocks(Corner corner, Point a, Point b, Point c, int strictness) const;
  bool enters(Corner corner, Point at, Point right, Point left) const;
  bool is_spike(Corner corner) const;
  Corner cut_off(Corner corner, std::vector<std::array<Corner, 3>>& out);
  void update_reflex(Corner corner);
  static double turn(Point a, Point b, Point c);

  std::vector<Point> points_;
  std::vector<Corner> next_, previous_;
  Corner left_ = 0;  ///< corners that are still there
  mutable std::uint64_t looks_ = 0;
  std::vector<char> may_block_;  ///< still there and not strictly convex
  // Corners by cell of a square grid: near an ear only few need a look.
  std::vector<std::uint32_t> cell_starts_;
  std::vector<Corner> cell_corners_;
  std::size_t grid_side_ = 1;
  Point grid_least_, grid_cells_per_unit_;
  std::vector<std::array<Corner, 3>> local_;
};

}  // namespace ds
