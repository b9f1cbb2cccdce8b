// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh.h"

#include <fmt/format.h>

#include <bit>
#include <span>
#include <string>
#include <type_traits>

namespace ds {
namespace {

/// Bytes as they lie in memory: dsbuild runs on little-endian machines only.
template <typename T>
void add_array(std::string& text, const char* name, const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);
  const Hash128 hash = hash_bytes(std::as_bytes(std::span(values)));
  text += fmt::format("{} {} {}\n", name, values.size(), hash.hex());
}

}  // namespace

Hash128 geometry_hash(const Mesh& mesh) {
  static_assert(std::endian::native == std::endian::little);
  static_assert(sizeof(Vec3) == 12 && sizeof(Vec2) == 8);
  std::string text = "mesh 1\n";
  add_array(text, "positions", mesh.positions);
  add_array(text, "normals", mesh.normals);
  add_array(text, "uvs", mesh.uvs);
  add_array(text, "triangles", mesh.triangles);
  return hash_text(text);
}

}  // namespace ds
