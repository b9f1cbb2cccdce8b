// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_polygons.h"
#include "tracer/scene/mesh_text.h"
#include "tracer/scene/mesh_topology.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace ds {
namespace {

using Key = std::array<std::uint32_t, 5>;

std::uint32_t bits(float x) {
  return std::bit_cast<std::uint32_t>(x);
}

/// Equal colours, and equal normals, have equal numbers.
std::vector<std::uint32_t> numbered(const std::vector<MeshColor>& colors) {
  std::vector<std::array<std::uint32_t, 4>> keys;
  keys.reserve(colors.size());
  for (const MeshColor& c : colors)
    keys.push_back({bits(c[0]), bits(c[1]), bits(c[2]), bits(c[3])});
  return first_equal<4>(keys);
}
std::vector<std::uint32_t> numbered(const std::vector<Vec3>& normals) {
  std::vector<std::array<std::uint32_t, 3>> keys;
  keys.reserve(normals.size());
  for (const Vec3 n : normals)
    keys.push_back({bits(n.x), bits(n.y), bits(n.z)});
  return first_equal<3>(keys);
}

/// What tells a corner from others of its vertex: uv, and the numbers of its normal and of its face's
/// colour.
std::vector<Key> corner_keys(const Polygons& polygons) {
  const std::vector<std::uint32_t> color = numbered(polygons.face_colors);
  const std::vector<std::uint32_t> normal = numbered(polygons.corner_normals);
  std::vector<Key> keys;
  keys.reserve(polygons.corners.size());
  std::size_t face = 0;
  for (std::size_t c = 0; c < polygons.corners.size(); ++c) {
    while (c >= polygons.face_ends[face])
      ++face;
    const Vec2 uv = polygons.corner_uvs.empty() ? Vec2{} : polygons.corner_uvs[c];
    keys.push_back({polygons.corners[c], bits(uv.x), bits(uv.y), color.empty() ? 0 : color[face],
                    normal.empty() ? 0 : normal[c]});
  }
  return keys;
}

class Splitter {
 public:
  explicit Splitter(Polygons& polygons) : polygons_(polygons) {
    const std::size_t vertices = polygons.positions.size();
    if (!polygons.corner_uvs.empty()) polygons.uvs.assign(vertices, {});
    if (!polygons.corner_normals.empty()) polygons.normals.assign(vertices, {});
    if (!polygons.face_colors.empty()) polygons.colors.assign(vertices, {1, 1, 1, 1});
  }

  void split() {
    const std::vector<Key> keys = corner_keys(polygons_);
    const std::vector<std::uint32_t> first = first_equal<5>(keys);
    std::vector<std::uint32_t> vertex_of(first.size(), LineCursor::k_bad_index);
    std::vector<char> used(polygons_.positions.size(), 0);
    std::size_t face = 0;
    for (std::size_t c = 0; c < first.size(); ++c) {
      while (c >= polygons_.face_ends[face])
        ++face;
      const std::uint32_t v = keys[c][0];
      if (first[c] == c && v < used.size()) {
        vertex_of[c] = used[v] ? copy(v) : v;
        used[v] = 1;
        if (!polygons_.corner_uvs.empty()) polygons_.uvs[vertex_of[c]] = polygons_.corner_uvs[c];
        if (!polygons_.corner_normals.empty())
          polygons_.normals[vertex_of[c]] = polygons_.corner_normals[c];
        if (!polygons_.face_colors.empty())
          polygons_.colors[vertex_of[c]] = polygons_.face_colors[face];
      }
      polygons_.corners[c] = vertex_of[first[c]];
    }
    polygons_.corner_uvs.clear();
    polygons_.corner_normals.clear();
    polygons_.face_colors.clear();
  }

 private:
  template <typename T>
  static void repeat(std::vector<T>& values, std::size_t place) {
    if (values.empty()) return;
    const T value = values[place];
    values.push_back(value);
  }

  std::uint32_t copy(std::size_t vertex) {
    repeat(polygons_.positions, vertex);
    repeat(polygons_.normals, vertex);
    repeat(polygons_.uvs, vertex);
    repeat(polygons_.colors, vertex);
    return static_cast<std::uint32_t>(polygons_.positions.size() - 1);
  }

  Polygons& polygons_;
};

/// What values of one kind say of the range that they run to.
class ColorRange {
 public:
  void add(float x) {
    if (!std::isfinite(x)) return;
    most_ = std::max(most_, x);
    whole_ = whole_ && x == std::floor(x);
  }
  float range() const {
    // Brighter than white by rounding or on purpose, as floats can be.
    constexpr float k_brightest = 16;
    if (most_ <= 1 || (!whole_ && most_ <= k_brightest)) return 1;
    return most_ <= 255 ? 255.0F : 65535.0F;
  }
  /// Of values that are not all 0.
  bool is_up_to(float limit) const { return most_ > 0 && most_ <= limit; }

 private:
  float most_ = 0;
  bool whole_ = true;
};

/// What rounding does not make of white.
bool is_bright(float x) {
  constexpr float k_rounded_white = 1.001F;
  return x > k_rounded_white && std::isfinite(x);
}

}  // namespace

std::uint64_t fill_missing_colors(std::vector<MeshColor>& colors) {
  const bool bytes = std::any_of(colors.begin(), colors.end(), [](const MeshColor& c) {
    return c[0] > 1 || c[1] > 1 || c[2] > 1;
  });
  const float white = bytes ? 255 : 1;
  std::uint64_t missing = 0;
  for (MeshColor& color : colors) {
    if (color != k_missing_color) continue;
    color = {white, white, white, k_no_alpha};
    ++missing;
  }
  return missing;
}

void unit_colors(std::vector<MeshColor>& colors, DarkColors dark, MeshReport& report) {
  ColorRange rgb, alpha;
  for (const MeshColor& c : colors) {
    for (std::size_t i = 0; i < 3; ++i)
      rgb.add(c[i]);
    alpha.add(c[3]);
  }
  if (rgb.is_up_to(dark.color) || alpha.is_up_to(dark.alpha)) report.dark_colors += colors.size();
  const float rgb_range = rgb.range(), alpha_range = alpha.range();
  for (MeshColor& c : colors) {
    for (std::size_t i = 0; i < 3; ++i)
      c[i] /= rgb_range;
    c[3] = c[3] == k_no_alpha ? 1.0F : c[3] / alpha_range;
    if (std::any_of(c.begin(), c.end(), [](float x) { return x < 0; })) ++report.negative_colors;
    if (std::any_of(c.begin(), c.end(), is_bright)) ++report.bright_colors;
    for (float& part : c)
      part = part < 0 ? 0.0F : part;
  }
}

void split_corners(Polygons& polygons, MeshReport& report) {
  unit_colors(polygons.colors, polygons.dark_colors, report);
  if (polygons.colors.empty()) unit_colors(polygons.face_colors, polygons.dark_face_colors, report);
  if (!polygons.colors.empty() && !polygons.face_colors.empty()) {
    report.unused_colors += 3;
    polygons.face_colors.clear();
  }
  if (!polygons.uvs.empty() && !polygons.corner_uvs.empty()) report.unused_uvs += 2;
  if (!polygons.normals.empty() && !polygons.corner_normals.empty()) report.unused_normals += 3;
  if (!polygons.corner_uvs.empty() || !polygons.corner_normals.empty() ||
      !polygons.face_colors.empty())
    Splitter(polygons).split();
}

}  // namespace ds
