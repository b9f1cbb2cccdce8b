// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/mesh_samples.h"

namespace ds {
namespace {

using samples::k_tetra_off;
using samples::k_tetra_ply;
using samples::put;
using samples::replaced;

Hash128 hash_of(std::string_view bytes) {
  return geometry_hash(parse_model(bytes, "m").mesh);
}

/// Saves a mesh as another program might.
template <typename T>
std::string as_binary_ply(const Mesh& mesh, std::endian order) {
  std::string file = fmt::format(
      "ply\nformat binary_{}_endian 1.0\nelement vertex {}\nproperty {} x\nproperty {} y\n"
      "property {} z\nelement face {}\nproperty list uchar uint vertex_index\nend_header\n",
      order == std::endian::little ? "little" : "big", mesh.positions.size(),
      sizeof(T) == 4 ? "float" : "double", sizeof(T) == 4 ? "float" : "double",
      sizeof(T) == 4 ? "float" : "double", mesh.triangles.size());
  for (const Vec3 p : mesh.positions)
    for (const float x : {p.x, p.y, p.z})
      put<T>(file, double{x}, order);
  for (const auto& t : mesh.triangles) {
    put<std::uint8_t>(file, 3, order);
    for (const std::uint32_t v : t)
      put<std::uint32_t>(file, v, order);
  }
  return file;
}

std::string as_off(const Mesh& mesh, const char* number) {
  std::string file =
      fmt::format("# saved again\nCOFF {} {} 0\n", mesh.positions.size(), mesh.triangles.size());
  for (const Vec3 p : mesh.positions) {
    for (const float x : {p.x, p.y, p.z})
      file += fmt::format(fmt::runtime(number), x) + " ";
    file += "255 255 255\n";
  }
  for (const auto& t : mesh.triangles)
    file += fmt::format("3 {} {} {} 7\n", t[0], t[1], t[2]);
  return file;
}

TEST(GeometryHash, DoesNotDependOnTheFormat) {
  // Coordinates with no short decimal form, a negative zero, and a very small number.
  const std::string file = replaced(replaced(k_tetra_off, "4 0 0", "0.1 -0 1e-40"), "0 4 0",
                                    "0.333333333 -7.00000047 1e17");
  const Mesh mesh = parse_model(file, "m").mesh;
  const Hash128 hash = geometry_hash(mesh);
  EXPECT_EQ(hash_of(as_binary_ply<float>(mesh, std::endian::little)), hash);
  EXPECT_EQ(hash_of(as_binary_ply<float>(mesh, std::endian::big)), hash);
  EXPECT_EQ(hash_of(as_binary_ply<double>(mesh, std::endian::little)), hash);
  EXPECT_EQ(hash_of(as_off(mesh, "{:.9g}")), hash);
  EXPECT_EQ(hash_of(as_off(mesh, "{:.20e}")), hash);
  EXPECT_EQ(hash_of(k_tetra_ply), hash_of(k_tetra_off));
}

TEST(GeometryHash, ChangesWithEveryPart) {
  const Mesh mesh =
      parse_model("STNOFF 3 1 0\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n3 0 1 2\n", "m")
          .mesh;
  const Hash128 hash = geometry_hash(mesh);
  Mesh changed = mesh;
  changed.positions[2].y = 1.0000001F;
  EXPECT_NE(geometry_hash(changed), hash);
  changed = mesh;
  changed.normals[0].x = 1e-30F;
  EXPECT_NE(geometry_hash(changed), hash);
  changed = mesh;
  changed.uvs[0].x = 1e-30F;
  EXPECT_NE(geometry_hash(changed), hash);
  changed = mesh;
  changed.triangles[0] = {1, 2, 0};
  EXPECT_NE(geometry_hash(changed), hash);
  changed = mesh;
  changed.normals.clear();
  EXPECT_NE(geometry_hash(changed), hash);
  // Normals do not pass for positions.
  changed = mesh;
  std::swap(changed.positions, changed.normals);
  EXPECT_NE(geometry_hash(changed), hash);
}

TEST(GeometryHash, IsTheSameOnEveryMachine) {
  // The value a first run gave: a change here makes every dataset stale.
  EXPECT_EQ(hash_of(k_tetra_off).hex(), "4ccb2b2ab92b69a6fe192b421ff72c0e");
}

}  // namespace
}  // namespace ds
