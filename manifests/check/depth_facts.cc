// SPDX-License-Identifier: Apache-2.0
#include "manifests/check/depth_facts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ds {
namespace {

/// Encodings round: millimetres, and halves of 11 bits.
constexpr double k_rounding_m = 1e-3, k_rounding = 1e-3;

struct Axes {
  Vec3d right, down, forward, at;
};

/// Columns of a 4x4 matrix.
Axes axes_of(const std::array<double, 16>& m) {
  return {{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}, {m[3], m[7], m[11]}};
}

double size_of(const ModelPose& pose) {
  const auto corners = corners_of(pose);
  return length(corners.back() - corners.front());
}

/// The box around the model and a margin, in the model file's coordinates.
class PlacedBox {
 public:
  PlacedBox(const ModelPose& pose, double margin_m)
      : axes_(axes_of(pose.model_to_world)), box_(pose.model_box), margin_m_(margin_m) {}

  bool holds(Vec3d point) const {
    const Vec3d way = point - axes_.at;
    return within(way, axes_.right, box_.least.x, box_.most.x) &&
           within(way, axes_.down, box_.least.y, box_.most.y) &&
           within(way, axes_.forward, box_.least.z, box_.most.z);
  }

 private:
  /// The matrix turns and scales alike, so its columns are square to each other.
  bool within(Vec3d way, Vec3d axis, double least, double most) const {
    const double scale = length(axis);
    const double at = dot(way, axis) / scale;
    return at >= least * scale - margin_m_ && at <= most * scale + margin_m_;
  }

  Axes axes_;
  Box box_;
  double margin_m_;
};

/// What an image sees at or near a place in its picture: the nearest of 3 x 3 pixels; nothing where these
/// are not all in it.
std::optional<double> nearest_around(const DepthView& view, Vec3d pixel) {
  const int width = view.record->width, height = view.record->height;
  if (!(pixel.z > 0) || !(pixel.x >= 1) || !(pixel.y >= 1) || !(pixel.x < width - 1) ||
      !(pixel.y < height - 1))
    return std::nullopt;
  const int x = static_cast<int>(pixel.x), y = static_cast<int>(pixel.y);
  double nearest = std::numeric_limits<double>::infinity();
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u) {
      const double depth =
          double{view.depth[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(u)]};
      if (depth > 0) nearest = std::min(nearest, depth);
    }
  return nearest;
}

/// The corners, turn by turn, of what 3 x 3 pixels show where that is one flat piece of the model: each
/// two that lie opposite have the middle's depth between them, but for `far`.
std::optional<std::array<Vec3d, 4>> piece_around(const DepthView& view, std::size_t pixel,
                                                 double far) {
  const ImageRecord& record = *view.record;
  const auto width = static_cast<std::size_t>(record.width);
  const int x = static_cast<int>(pixel % width), y = static_cast<int>(pixel / width);
  if (x < 1 || y < 1 || x + 1 >= record.width || y + 1 >= record.height) return std::nullopt;
  std::array<Vec3d, 4> corners;
  std::size_t corner = 0;
  for (const auto& [dx, dy] :
       {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 0), std::pair(0, 1)}) {
    const std::size_t step = static_cast<std::size_t>(dy) * width + static_cast<std::size_t>(dx);
    const std::size_t before = pixel - step, behind = pixel + step;  // modulo 2^64, also backwards
    if (view.mask[before] == 0 || view.mask[behind] == 0) return std::nullopt;
    const double a = double{view.depth[before]}, b = double{view.depth[behind]};
    if (!(a > 0) || !(b > 0)) return std::nullopt;
    // Of a plane, 1 / depth is linear over a pinhole's picture.
    const double between = record.intrinsics ? 2 / (1 / a + 1 / b) : (a + b) / 2;
    if (!(std::abs(between - double{view.depth[pixel]}) <= far)) return std::nullopt;
    if (dx == 0 || dy == 0) continue;
    corners.at(corner) = point_at(record, x + dx, y + dy, b);
    corners.at(corner + 2) = point_at(record, x - dx, y - dy, a);
    ++corner;
  }
  return corners;
}

/// The piece's greatest depth, where it hides what lies behind it from the middle of the pixel at that place.
std::optional<double> depth_over_middle(const std::array<Vec3d, 4>& piece, const ImageRecord& other,
                                        Vec3d there) {
  const double x = std::floor(there.x) + 0.5, y = std::floor(there.y) + 0.5;
  int left = 0, right = 0;
  double farthest = 0;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const Vec3d a = pixel_of(other, piece.at(i)), b = pixel_of(other, piece.at((i + 1) % 4));
    if (!(a.z > 0)) return std::nullopt;
    farthest = std::max(farthest, a.z);
    const double turn = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    left += turn > 0 ? 1 : 0;
    right += turn < 0 ? 1 : 0;
  }
  return left == 4 || right == 4 ? std::optional(farthest) : std::nullopt;
}

}  // namespace

Vec3d point_at(const ImageRecord& record, int x, int y, double depth) {
  const Axes camera = axes_of(record.camera_to_world);
  double across = x + 0.5, below = y + 0.5;
  if (record.intrinsics) {
    const auto& k = *record.intrinsics;
    across = (across - k[2]) / k[0] * depth;
    below = (below - k[5]) / k[4] * depth;
  } else {
    across = (across - record.width / 2.0) * record.metres_per_pixel.value_or(0);
    below = (below - record.height / 2.0) * record.metres_per_pixel.value_or(0);
  }
  return camera.at + camera.right * across + camera.down * below + camera.forward * depth;
}

Vec3d pixel_of(const ImageRecord& record, Vec3d point) {
  const Axes camera = axes_of(record.camera_to_world);
  const Vec3d way = point - camera.at;
  const double x = dot(way, camera.right), y = dot(way, camera.down),
               depth = dot(way, camera.forward);
  if (!record.intrinsics)
    return {record.width / 2.0 + x / record.metres_per_pixel.value_or(1),
            record.height / 2.0 + y / record.metres_per_pixel.value_or(1), depth};
  const auto& k = *record.intrinsics;
  return {k[2] + k[0] * x / depth, k[5] + k[4] * y / depth, depth};
}

std::array<Vec3d, 8> corners_of(const ModelPose& pose) {
  const Axes axes = axes_of(pose.model_to_world);
  std::array<Vec3d, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = axes.at +
                 axes.right * ((i & 1U) != 0 ? pose.model_box.most.x : pose.model_box.least.x) +
                 axes.down * ((i & 2U) != 0 ? pose.model_box.most.y : pose.model_box.least.y) +
                 axes.forward * ((i & 4U) != 0 ? pose.model_box.most.z : pose.model_box.least.z);
  return corners;
}

DepthFacts depth_facts(const DepthView& own, const DepthView* other) {
  constexpr std::uint64_t k_most = 1000;
  const ImageRecord& record = *own.record;
  const double far = size_of(*record.pose) / 100 + k_rounding_m;
  const auto width = static_cast<std::size_t>(record.width);
  DepthFacts facts;
  facts.shown = static_cast<std::uint64_t>(
      own.mask.size() - static_cast<std::size_t>(std::count(own.mask.begin(), own.mask.end(), 0)));
  const std::uint64_t stride = facts.shown / k_most + 1;
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < own.mask.size(); ++i) {
    if (own.mask[i] == 0) continue;
    const double depth = double{own.depth[i]};
    const Vec3d point =
        point_at(record, static_cast<int>(i % width), static_cast<int>(i / width), depth);
    const PlacedBox box(*record.pose, far + depth * k_rounding);
    if (!(depth > 0) || !box.holds(point)) {
      ++facts.elsewhere;
      continue;
    }
    if (other == nullptr || number++ % stride != 0) continue;
    const Vec3d there = pixel_of(*other->record, point);
    const auto nearest = nearest_around(*other, there);
    const auto piece = nearest ? piece_around(own, i, far) : std::nullopt;
    const auto deepest = piece ? depth_over_middle(*piece, *other->record, there) : std::nullopt;
    if (!deepest) continue;
    ++facts.compared;
    facts.missed += *nearest > *deepest + far + *deepest * k_rounding ? 1U : 0U;
  }
  return facts;
}

}  // namespace ds
