// SPDX-License-Identifier: Apache-2.0
#include "manifests/export/bop_model.h"

#include "manifests/canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace ds {
namespace {

constexpr double k_mm = 1000;

Vec3d moved(const std::array<double, 16>& m, Vec3d p) {
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
          m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}

/// The farthest from the origin first: two points are no farther from each other than their distances
/// from it together, which ends most of the search.
double diameter_of(const std::vector<Vec3d>& points) {
  std::vector<double> radii;
  radii.reserve(points.size());
  for (const Vec3d p : points)
    radii.push_back(length(p));
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return radii[a] > radii[b]; });
  double squared = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double rest = std::sqrt(squared) - radii[order[i]];
    if (i > 0 && radii[order[0]] < rest) break;
    for (std::size_t j = 0; j < i; ++j) {
      if (radii[order[j]] < rest) break;
      const Vec3d between = points[order[i]] - points[order[j]];
      squared = std::max(squared, dot(between, between));
    }
  }
  return std::sqrt(squared);
}

Silhouette found_on(const Canvas& canvas, int width, int height) {
  Silhouette s;
  std::array<int, 4> box{2 * width, 2 * height, -width - 1, -height - 1};
  canvas.visit([&](int x, int y) {
    ++s.pixels;
    if (x >= 0 && y >= 0 && x < width && y < height) s.inside.push_back({x, y});
    box = {std::min(box[0], x), std::min(box[1], y), std::max(box[2], x), std::max(box[3], y)};
  });
  if (s.pixels > 0) s.box = {box[0], box[1], box[2] - box[0], box[3] - box[1]};
  return s;
}

}  // namespace

BopModel bop_model(const FileMesh& mesh, const ModelPose& pose) {
  BopModel model;
  for (const Vec3d p : mesh.positions)
    model.points.push_back(moved(pose.model_to_world, p));
  Box box{model.points.at(0), model.points.at(0)};
  for (const Vec3d p : model.points) {
    box.least = {std::min(box.least.x, p.x), std::min(box.least.y, p.y),
                 std::min(box.least.z, p.z)};
    box.most = {std::max(box.most.x, p.x), std::max(box.most.y, p.y), std::max(box.most.z, p.z)};
  }
  model.middle_m = (box.least + box.most) * 0.5;
  for (Vec3d& p : model.points)
    p = (p - model.middle_m) * k_mm;
  model.triangles = mesh.triangles;
  model.least = (box.least - model.middle_m) * k_mm;
  model.most = (box.most - model.middle_m) * k_mm;
  model.diameter = diameter_of(model.points);
  return model;
}

std::string ply_text(const BopModel& model) {
  std::vector<Vec3d> normals(model.points.size());
  for (const auto& t : model.triangles) {
    const Vec3d a = model.points[t[0]];
    const Vec3d across = cross(model.points[t[1]] - a, model.points[t[2]] - a);
    for (const std::uint32_t corner : t)
      normals[corner] = normals[corner] + across;
  }
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty "
      "float "
      "z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face {}\nproperty list "
      "uchar int vertex_indices\nend_header\n",
      model.points.size(), model.triangles.size());
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const Vec3d p = model.points[i] + Vec3d{}, n = normalized(normals[i]) + Vec3d{};  // no -0
    fmt::format_to(std::back_inserter(text), "{:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}\n", p.x,
                   p.y, p.z, n.x, n.y, n.z);
  }
  for (const auto& t : model.triangles)
    fmt::format_to(std::back_inserter(text), "3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

Silhouette silhouette(const BopModel& model, const std::array<double, 12>& to_camera,
                      const std::array<double, 9>& intrinsics, int width, int height) {
  const auto& m = to_camera;
  std::vector<std::array<double, 2>> seen;
  std::vector<bool> before;
  seen.reserve(model.points.size());
  before.reserve(model.points.size());
  for (const Vec3d p : model.points) {
    const double z = m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11];
    const double x = m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3];
    const double y = m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7];
    before.push_back(z > 0);
    seen.push_back({intrinsics[0] * x / z + intrinsics[2], intrinsics[4] * y / z + intrinsics[5]});
  }
  Canvas canvas(-width, -height, 3 * width, 3 * height);
  bool whole = true;
  for (const auto& t : model.triangles) {
    if (before[t[0]] && before[t[1]] && before[t[2]])
      canvas.cover(seen[t[0]], seen[t[1]], seen[t[2]]);
    else
      whole = false;
  }
  Silhouette found = found_on(canvas, width, height);
  found.whole = whole;
  return found;
}

}  // namespace ds
