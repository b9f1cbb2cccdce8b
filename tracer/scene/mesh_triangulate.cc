// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_triangulate.h"

#include "tracer/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace ds {
namespace {

/// How little is asked of an ear: see is_ear.
constexpr int k_no_area = 1, k_any_corner = 3;

/// Twice the area vector of a polygon (Newell), about its first corner so that a far polygon keeps
/// its digits.
Vec3d area_vector(std::span<const Vec3d> positions, std::span<const std::uint32_t> polygon) {
  const Vec3d origin = positions[polygon[0]];
  Vec3d sum;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum = sum + cross(positions[polygon[i]] - origin, positions[polygon[i + 1]] - origin);
  return sum;
}

}  // namespace

bool Triangulator::triangulate(std::span<const Vec3d> positions,
                               std::span<const std::uint32_t> polygon,
                               std::vector<std::array<std::uint32_t, 3>>& out) {
  DS_ASSERT(polygon.size() >= 3);
  if (polygon.size() == 3) {
    out.push_back({polygon[0], polygon[1], polygon[2]});
    return true;
  }
  // A polygon without an area vector has no inside to keep to; a fan is as good as any.
  if (!project(positions, polygon) || is_strictly_convex()) {
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      out.push_back({polygon[0], polygon[i], polygon[i + 1]});
    return true;
  }
  build_grid();
  local_.clear();
  if (!clip_ears(local_)) return false;
  for (const auto& [a, b, c] : local_)
    out.push_back({polygon[a], polygon[b], polygon[c]});
  return true;
}

/// Fills points_, counter-clockwise as a whole. False where the area vector is zero.
bool Triangulator::project(std::span<const Vec3d> positions,
                           std::span<const std::uint32_t> polygon) {
  const Vec3d area = area_vector(positions, polygon);
  const double x = std::fabs(area.x), y = std::fabs(area.y), z = std::fabs(area.z);
  const int axis = x > y && x > z ? 0 : y > z ? 1 : 2;
  if (area[axis] == 0) return false;
  // Dropping an axis seen from its positive side leaves the next two, in cyclic order.
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (area[axis] < 0) std::swap(u, v);
  points_.clear();
  for (const std::uint32_t index : polygon)
    points_.push_back({positions[index][u], positions[index][v]});
  return true;
}

/// Twice the signed area of a triangle: above 0 for a left turn at b.
double Triangulator::turn(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool Triangulator::is_strictly_convex() const {
  const std::size_t n = points_.size();
  for (std::size_t i = 0; i < n; ++i)
    if (!(turn(points_[i], points_[(i + 1) % n], points_[(i + 2) % n]) > 0)) return false;
  // Left turns only, but perhaps more than once around (a pentagram).
  for (std::size_t i = 1; i + 1 < n; ++i)
    if (!(turn(points_[0], points_[i], points_[i + 1]) > 0)) return false;
  return true;
}

void Triangulator::build_grid() {
  const auto [least_x, most_x] = std::minmax_element(points_.begin(), points_.end(),
                                                     [](Point a, Point b) { return a.x < b.x; });
  const auto [least_y, most_y] = std::minmax_element(points_.begin(), points_.end(),
                                                     [](Point a, Point b) { return a.y < b.y; });
  constexpr std::size_t k_most_cells_a_side = 1024;
  grid_side_ = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::sqrt(static_cast<double>(points_.size()))), 1,
      k_most_cells_a_side);
  const double side = static_cast<double>(grid_side_);
  grid_least_ = {least_x->x, least_y->y};
  grid_cells_per_unit_ = {side / (most_x->x - least_x->x), side / (most_y->y - least_y->y)};

  const auto cell = [&](Point p) {
    return cell_of(p.y, grid_least_.y, grid_cells_per_unit_.y) * grid_side_ +
           cell_of(p.x, grid_least_.x, grid_cells_per_unit_.x);
  };
  cell_starts_.assign(grid_side_ * grid_side_ + 1, 0);
  for (const Point p : points_)
    ++cell_starts_[cell(p) + 1];
  for (std::size_t i = 1; i < cell_starts_.size(); ++i)
    cell_starts_[i] += cell_starts_[i - 1];
  cell_corners_.resize(points_.size());
  std::vector<std::uint32_t> at(cell_starts_.begin(), cell_starts_.end() - 1);
  for (Corner i = 0; i < points_.size(); ++i)
    cell_corners_[at[cell(points_[i])]++] = i;
}

std::size_t Triangulator::cell_of(double value, double least, double cells_per_unit) const {
  const double cell = (value - least) * cells_per_unit;
  if (!(cell > 0)) return 0;
  return cell < static_cast<double>(grid_side_) ? static_cast<std::size_t>(cell) : grid_side_ - 1;
}

/// False where it takes too long.
bool Triangulator::clip_ears(std::vector<std::array<Corner, 3>>& out) {
  const auto n = static_cast<Corner>(points_.size());
  next_.resize(n);
  previous_.resize(n);
  may_block_.resize(n);
  for (Corner i = 0; i < n; ++i) {
    next_[i] = i + 1 == n ? 0 : i + 1;
    previous_[i] = i == 0 ? n - 1 : i - 1;
  }
  may_block_.assign(n, 0);
  left_ = n;
  for (Corner i = 0; i < n; ++i)
    update_reflex(i);
  Corner corner = 0;
  for (Corner i = 0; i < n; ++i)
    if (next_[i] != i && is_spike(i)) corner = cut_off(i, out);

  looks_ = 0;
  int strictness = 0;
  for (Corner tried = 0; left_ > 3;) {
    if (looks_ > k_most_looks) return false;
    if (!is_ear(corner, strictness)) {
      corner = next_[corner];
      if (++tried == left_) {
        DS_ASSERT(strictness < k_any_corner);
        ++strictness;
        tried = 0;
      }
      continue;
    }
    // Not the next one: ears in turn make better shapes than a fan.
    corner = next_[cut_off(corner, out)];
    tried = 0;
    if (strictness == k_no_area) strictness = 0;  // what it stood before may be an ear
  }
  out.push_back({previous_[corner], corner, next_[corner]});
  return true;
}

/// Whether the way goes to the corner and straight back, or stays where it is.
bool Triangulator::is_spike(Corner corner) const {
  const Point a = points_[previous_[corner]], b = points_[corner], c = points_[next_[corner]];
  return left_ > 3 && turn(a, b, c) == 0 &&
         (a == b || b == c || (a.x - b.x) * (c.x - b.x) + (a.y - b.y) * (c.y - b.y) > 0);
}

/// And the spikes that this makes of its neighbours; returns the corner behind what was cut off.
Triangulator::Corner Triangulator::cut_off(Corner corner, std::vector<std::array<Corner, 3>>& out) {
  for (;;) {
    const Corner before = previous_[corner], after = next_[corner];
    out.push_back({before, corner, after});
    next_[before] = after;
    previous_[after] = before;
    next_[corner] = corner;  // it is gone
    may_block_[corner] = 0;
    --left_;
    update_reflex(before);
    update_reflex(after);
    if (is_spike(before))
      corner = before;
    else if (is_spike(after))
      corner = after;
    else
      return after;
  }
}

void Triangulator::update_reflex(Corner corner) {
  const double left = turn(points_[previous_[corner]], points_[corner], points_[next_[corner]]);
  may_block_[corner] = left > 0 ? 0 : 1;
}

/// `strictness` 0: no other corner on or in the triangle; k_no_area: a triangle without area; 2: no
/// corner in it; k_any_corner.
bool Triangulator::is_ear(Corner corner, int strictness) const {
  ++looks_;
  if (strictness == k_any_corner) return true;
  const Point a = points_[previous_[corner]], b = points_[corner], c = points_[next_[corner]];
  if (strictness == k_no_area) return turn(a, b, c) == 0;
  if (may_block_[corner]) return false;
  const auto [x0, x1] = std::minmax({a.x, b.x, c.x});
  const auto [y0, y1] = std::minmax({a.y, b.y, c.y});
  const std::size_t cx0 = cell_of(x0, grid_least_.x, grid_cells_per_unit_.x);
  const std::size_t cx1 = cell_of(x1, grid_least_.x, grid_cells_per_unit_.x);
  const std::size_t cy0 = cell_of(y0, grid_least_.y, grid_cells_per_unit_.y);
  const std::size_t cy1 = cell_of(y1, grid_least_.y, grid_cells_per_unit_.y);
  for (std::size_t cy = cy0; cy <= cy1; ++cy) {
    // The cells of one row are neighbours in the list too.
    const std::size_t row = cy * grid_side_;
    looks_ += 1 + cell_starts_[row + cx1 + 1] - cell_starts_[row + cx0];
    for (std::uint32_t i = cell_starts_[row + cx0]; i < cell_starts_[row + cx1 + 1]; ++i)
      if (blocks(cell_corners_[i], a, b, c, strictness)) return false;
  }
  return true;
}

/// Whether an edge of the corner, which stands at `at`, leads into the ear there, between its edges to
/// `right` and `left`.
bool Triangulator::enters(Corner corner, Point at, Point right, Point left) const {
  for (const Corner other : {previous_[corner], next_[corner]}) {
    const Point to = points_[other];
    if (turn(at, right, to) > 0 && turn(at, to, left) > 0) return true;
  }
  return false;
}

/// Whether a corner lies in the way of cutting off the ear abc. A corner at the place of one of the
/// three does where its edges lead into the ear: polygons with a hole are written with a slit whose
/// corners occur twice, and others touch themselves in a corner.
bool Triangulator::blocks(Corner corner, Point a, Point b, Point c, int strictness) const {
  if (!may_block_[corner]) return false;
  const Point p = points_[corner];
  if (p == a) return enters(corner, a, b, c);
  if (p == b) return enters(corner, b, c, a);
  if (p == c) return enters(corner, c, a, b);
  const double ab = turn(a, b, p), bc = turn(b, c, p), ca = turn(c, a, p);
  return strictness == 0 ? ab >= 0 && bc >= 0 && ca >= 0 : ab > 0 && bc > 0 && ca > 0;
}

}  // namespace ds
