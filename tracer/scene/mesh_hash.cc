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
Hash128 hash_of(const char* name, const std::vector<Position>& positions, const MeshOf& mesh,
                MeshExtras extras) {
  static_assert(std::endian::native == std::endian::little);
  static_assert(sizeof(Vec3) == 12 && sizeof(Vec3d) == 24 && sizeof(Vec2) == 8);
  std::string text = "mesh 1\n";
  add_array(text, name, positions);
  add_array(text, "normals", extras.normals ? mesh.normals : std::vector<Vec3>());
  add_array(text, "uvs", extras.uvs ? mesh.uvs : std::vector<Vec2>());
  add_array(text, "triangles", mesh.triangles);
  if (extras.colors && !mesh.colors.empty()) add_array(text, "colors", mesh.colors);
  return hash_text(text);
}

template <typename T>
Hash128 hash_of_extra(const std::vector<T>& values) {
  return values.empty() ? Hash128{} : hash_bytes(std::as_bytes(std::span(values)));
}

}  // namespace

Hash128 geometry_hash(const Mesh& mesh, MeshExtras extras) {
  return hash_of("positions", mesh.positions, mesh, extras);
}

Hash128 geometry_hash(const FileMesh& mesh, MeshExtras extras) {
  std::vector<Vec3> rounded;
  rounded.reserve(mesh.positions.size());
  for (const Vec3d p : mesh.positions) {
    rounded.push_back(to_float(p));
    if (to_double(rounded.back()) != p)
      return hash_of("double positions", mesh.positions, mesh, extras);
  }
  return hash_of("positions", rounded, mesh, extras);
}

MeshHashes mesh_hashes(const FileMesh& mesh) {
  return {geometry_hash(mesh, MeshExtras{}), hash_of_extra(mesh.uvs), hash_of_extra(mesh.colors),
          hash_of_extra(mesh.normals)};
}

}  // namespace ds
