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

template <typename Position, typename MeshOf>
Hash128 hash_of(const char* name, const std::vector<Position>& positions, const MeshOf& mesh) {
  static_assert(std::endian::native == std::endian::little);
  static_assert(sizeof(Vec3) == 12 && sizeof(Vec3d) == 24 && sizeof(Vec2) == 8);
  std::string text = "mesh 1\n";
  add_array(text, name, positions);
  add_array(text, "normals", mesh.normals);
  add_array(text, "uvs", mesh.uvs);
  add_array(text, "triangles", mesh.triangles);
  if (!mesh.colors.empty()) add_array(text, "colors", mesh.colors);
  return hash_text(text);
}

}  // namespace

Hash128 geometry_hash(const Mesh& mesh) {
  return hash_of("positions", mesh.positions, mesh);
}

Hash128 geometry_hash(const FileMesh& mesh) {
  std::vector<Vec3> rounded;
  rounded.reserve(mesh.positions.size());
  for (const Vec3d p : mesh.positions) {
    rounded.push_back(to_float(p));
    if (to_double(rounded.back()) != p) return hash_of("double positions", mesh.positions, mesh);
  }
  return hash_of("positions", rounded, mesh);
}

}  // namespace ds
