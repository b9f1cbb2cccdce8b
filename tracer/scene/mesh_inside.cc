// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_inside.h"

#include <algorithm>
#include <array>
#include <utility>

namespace ds {
namespace {

/// +1 where the edge from a to b passes `p` upwards in y on the side of greater x, -1 downwards,
/// else 0. An edge and the same edge the other way round differ in sign alone.
int passes(Vec3d a, Vec3d b, Vec3d p) {
  const bool upwards = a.y <= p.y;
  if (upwards == (b.y <= p.y)) return 0;
  const Vec3d low = upwards ? a : b, high = upwards ? b : a;
  const double side = (high.x - low.x) * (p.y - low.y) - (p.x - low.x) * (high.y - low.y);
  if (side < 0) return 0;
  return upwards ? 1 : -1;
}

/// Whether the triangle's plane is above `p`, where its shadow holds p and so is not a line.
bool is_above(const std::array<Vec3d, 3>& corners, Vec3d p) {
  const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double height = dot(normal, corners[0] - p);
  return normal.z > 0 ? height > 0 : height < 0;
}

}  // namespace

MeshInside::MeshInside(std::span<const Vec3d> positions, std::span<const Triangle> all,
                       std::span<const std::uint32_t> triangles)
    : positions_(positions), all_(all), triangles_(triangles) {
  least_ = most_ = positions[all[triangles[0]][0]];
  for (const std::uint32_t t : triangles)
    for (const std::uint32_t v : all[t]) {
      const Vec3d p = positions[v];
      least_ = {std::min(least_.x, p.x), std::min(least_.y, p.y), std::min(least_.z, p.z)};
      most_ = {std::max(most_.x, p.x), std::max(most_.y, p.y), std::max(most_.z, p.z)};
    }
}

Vec3d MeshInside::centre_of(std::uint32_t triangle) const {
  const Triangle& t = all_[triangle];
  return (positions_[t[0]] + positions_[t[1]] + positions_[t[2]]) * (1.0 / 3);
}

std::size_t MeshInside::row_of(double y) const {
  const std::size_t rows = row_starts_.size() - 1;
  const double row = (y - least_.y) / (most_.y - least_.y) * static_cast<double>(rows);
  if (!(row > 0)) return 0;
  return row < static_cast<double>(rows) ? static_cast<std::size_t>(row) : rows - 1;
}

void MeshInside::sort_into_rows() {
  constexpr std::size_t k_most_rows = 1024;
  row_starts_.assign(std::min(triangles_.size(), k_most_rows) + 1, 0);
  const auto rows_of = [&](std::uint32_t t) {
    const auto [a, b, c] = all_[t];
    const auto [low, high] = std::minmax({positions_[a].y, positions_[b].y, positions_[c].y});
    return std::pair{row_of(low), row_of(high)};
  };
  std::vector<std::uint32_t> starts(row_starts_.size(), 0);
  for (const std::uint32_t t : triangles_) {
    const auto [first, last] = rows_of(t);
    for (std::size_t row = first; row <= last; ++row)
      ++starts[row + 1];
  }
  for (std::size_t row = 1; row < starts.size(); ++row)
    starts[row] += starts[row - 1];
  row_triangles_.resize(starts.back());
  std::vector<std::uint32_t> fill(starts.begin(), starts.end() - 1);
  for (const std::uint32_t t : triangles_) {
    const auto [first, last] = rows_of(t);
    for (std::size_t row = first; row <= last; ++row)
      row_triangles_[fill[row]++] = t;
  }
  row_starts_ = std::move(starts);
}

bool MeshInside::holds(Vec3d p) {
  if (row_starts_.empty()) sort_into_rows();
  const std::size_t row = row_of(p.y);
  int passed = 0;
  for (std::uint32_t i = row_starts_[row]; i < row_starts_[row + 1]; ++i) {
    const Triangle& t = all_[row_triangles_[i]];
    const std::array<Vec3d, 3> c{positions_[t[0]], positions_[t[1]], positions_[t[2]]};
    const int shadow = passes(c[0], c[1], p) + passes(c[1], c[2], p) + passes(c[2], c[0], p);
    if (shadow != 0 && is_above(c, p)) ++passed;
  }
  return passed % 2 != 0;
}

bool MeshInside::holds(const MeshInside& other) {
  const bool within = other.least_.x >= least_.x && other.least_.y >= least_.y &&
                      other.least_.z >= least_.z && other.most_.x <= most_.x &&
                      other.most_.y <= most_.y && other.most_.z <= most_.z;
  if (!within) return false;
  const std::size_t count = other.triangles_.size();
  int inside = 0;
  for (const std::size_t i : {std::size_t{0}, count / 3, 2 * count / 3})
    inside += holds(other.centre_of(other.triangles_[i])) ? 1 : 0;
  return inside >= 2;
}

}  // namespace ds
