// SPDX-License-Identifier: Apache-2.0
#include "tracer/accel/ray_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace ds {
namespace {

using Corners = std::array<Vec3, 3>;

/// Where the ray meets the triangle (Moller and Trumbore 1997, in doubles); t > 0.
std::optional<double> met(const Corners& corners, Vec3d origin, Vec3d direction) {
  const Vec3d a = to_double(corners[0]), edge1 = to_double(corners[1]) - a,
              edge2 = to_double(corners[2]) - a;
  const Vec3d p = cross(direction, edge2);
  const double determinant = dot(edge1, p);
  if (determinant == 0) return std::nullopt;
  const Vec3d from = origin - a;
  const double u = dot(from, p) / determinant;
  if (!(u >= 0 && u <= 1)) return std::nullopt;
  const Vec3d q = cross(from, edge1);
  const double v = dot(direction, q) / determinant;
  if (!(v >= 0 && u + v <= 1)) return std::nullopt;
  const double t = dot(edge2, q) / determinant;
  return t > 0 ? std::optional(t) : std::nullopt;
}

/// Where the ray enters the box, `k_passes` where it does not. Widened by rounding's share, so that no box of
/// a triangle that is met is passed by.
constexpr double k_passes = std::numeric_limits<double>::infinity();
double entry(const NodeBox& box, Vec3d origin, Vec3d direction) {
  constexpr double k_wider = 1 + 1e-12;
  double near_t = 0, far_t = std::numeric_limits<double>::max();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double o = origin[static_cast<int>(axis)], d = direction[static_cast<int>(axis)];
    const double low = double{box.low[axis]} - o, high = double{box.high[axis]} - o;
    if (d == 0) {
      if (low > 0 || high < 0) return k_passes;
      continue;
    }
    near_t = std::max(near_t, std::min(low / d, high / d));
    far_t = std::min(far_t, std::max(low / d, high / d));
  }
  return near_t <= far_t * k_wider ? near_t / k_wider : k_passes;
}

double squared_distance(const NodeBox& box, Vec3d from) {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double p = from[static_cast<int>(axis)];
    const double away = std::max({double{box.low[axis]} - p, p - double{box.high[axis]}, 0.0});
    sum += away * away;
  }
  return sum;
}

/// Ericson, Real-Time Collision Detection (2005), 5.1.5.
double squared_distance(const Corners& corners, Vec3d p) {
  const Vec3d a = to_double(corners[0]), b = to_double(corners[1]), c = to_double(corners[2]);
  const auto away = [&](Vec3d point) { return dot(p - point, p - point); };
  const Vec3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return away(a);
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return away(b);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return away(a + ab * (d1 / (d1 - d3)));
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return away(c);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return away(a + ac * (d2 / (d2 - d6)));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return away(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
  const double whole = va + vb + vc;
  return away(a + ab * (vb / whole) + ac * (vc / whole));
}

}  // namespace

RayTree::RayTree(std::vector<Corners> triangles) : triangles_(std::move(triangles)) {
  // Without spatial splits: a triangle stands in one leaf, and is counted once.
  if (!triangles_.empty()) nodes_ = build_binary_tree(triangles_, BvhQuality::medium);
}

/// From near to far, so that what is met early keeps the walk from what lies behind.
template <typename Enter, typename Bound, typename Meet>
void RayTree::walk(const Enter& enter, const Bound& bound, const Meet& meet) const {
  if (nodes_.empty()) return;
  std::vector<std::pair<double, std::uint32_t>> open;
  open.reserve(64);
  const auto push = [&](double key, std::uint32_t node) {
    if (key != k_passes && key <= bound()) open.emplace_back(key, node);
  };
  const auto root = static_cast<std::uint32_t>(nodes_.size() - 1);
  push(enter(nodes_[root].bounds), root);
  while (!open.empty()) {
    const auto [key, at] = open.back();
    open.pop_back();
    if (key > bound()) continue;
    const BinaryNode& node = nodes_[at];
    if (node.left == at && node.right == at) {
      meet(triangles_[node.triangle]);
      continue;
    }
    const double left = enter(nodes_[node.left].bounds), right = enter(nodes_[node.right].bounds);
    push(std::max(left, right), left > right ? node.left : node.right);
    push(std::min(left, right), left > right ? node.right : node.left);
  }
}

double RayTree::nearest(Vec3d origin, Vec3d direction, double most) const {
  double least = most;
  walk([&](const NodeBox& box) { return entry(box, origin, direction); }, [&] { return least; },
       [&](const Corners& corners) {
         if (const auto t = met(corners, origin, direction)) least = std::min(least, *t);
       });
  return least;
}

int RayTree::crossings(Vec3d origin, Vec3d direction) const {
  int count = 0;
  walk([&](const NodeBox& box) { return entry(box, origin, direction); },
       [] { return std::numeric_limits<double>::max(); },
       [&](const Corners& corners) { count += met(corners, origin, direction) ? 1 : 0; });
  return count;
}

double RayTree::distance(Vec3d from, double most) const {
  double least = most * most;
  walk([&](const NodeBox& box) { return squared_distance(box, from); }, [&] { return least; },
       [&](const Corners& corners) { least = std::min(least, squared_distance(corners, from)); });
  return least < most * most ? std::sqrt(least) : most;
}

}  // namespace ds
