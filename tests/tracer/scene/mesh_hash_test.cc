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
std::string as_binary_ply(const FileMesh& mesh, std::endian order) {
  std::string file = fmt::format(
      "ply\nformat binary_{}_endian 1.0\nelement vertex {}\nproperty {} x\nproperty {} y\n"
      "property {} z\nelement face {}\nproperty list uchar uint vertex_index\nend_header\n",
      order == std::endian::little ? "little" : "big", mesh.positions.size(),
      sizeof(T) == 4 ? "float" : "double", sizeof(T) == 4 ? "float" : "double",
      sizeof(T) == 4 ? "float" : "double", mesh.triangles.size());
  for (const Vec3d p : mesh.positions)
    for (const double x : {p.x, p.y, p.z})
      put<T>(file, x, order);
  for (const auto& t : mesh.triangles) {
    put<std::uint8_t>(file, 3, order);
    for (const std::uint32_t v : t)
      put<std::uint32_t>(file, v, order);
  }
  return file;
}

std::string as_off(const FileMesh& mesh, const char* number) {
  std::string file =
      fmt::format("# saved again\nCOFF {} {} 0\n", mesh.positions.size(), mesh.triangles.size());
  for (const Vec3d p : mesh.positions) {
    for (const double x : {p.x, p.y, p.z})
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
  const FileMesh mesh = parse_model(file, "m").mesh;
  const Hash128 hash = geometry_hash(mesh);
  EXPECT_EQ(hash_of(as_binary_ply<float>(mesh, std::endian::little)), hash);
  EXPECT_EQ(hash_of(as_binary_ply<float>(mesh, std::endian::big)), hash);
  EXPECT_EQ(hash_of(as_binary_ply<double>(mesh, std::endian::little)), hash);
  EXPECT_EQ(hash_of(as_off(mesh, "{:.9g}")), hash);
  EXPECT_EQ(hash_of(as_off(mesh, "{:.20e}")), hash);
  EXPECT_EQ(hash_of(k_tetra_ply), hash_of(k_tetra_off));
}

TEST(GeometryHash, FarFromTheOriginIsOfTheDoubles) {
  // At a survey's coordinates a step that floats do not see is another body, and formats and
  // spellings still change nothing.
  const std::string file =
      "OFF 4 4 0\n412345.678 5678901.234 0\n412346.778 5678901.234 0\n412345.678 5678902.034 0\n"
      "412345.678 5678901.234 0.4\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const FileMesh mesh = parse_model(file, "m").mesh;
  EXPECT_EQ(mesh.positions[0], (Vec3d{412345.678, 5678901.234, 0}));
  const Hash128 hash = geometry_hash(mesh);
  EXPECT_EQ(hash_of(as_binary_ply<double>(mesh, std::endian::big)), hash);
  EXPECT_EQ(hash_of(as_off(mesh, "{:.17g}")), hash);
  EXPECT_EQ(hash_of(as_off(mesh, "{:.25e}")), hash);
  EXPECT_NE(hash_of(replaced(file, "412346.778", "412346.779")), hash);
  EXPECT_NE(hash_of(as_binary_ply<float>(mesh, std::endian::big)), hash);
  // A vertex far from the others that no face uses does not make the body a near one.
  EXPECT_EQ(hash_of(replaced(replaced(file, "OFF 4 4 0", "OFF 5 4 0"), "0.4\n", "0.4\n0 0 0\n")),
            hash);
}

TEST(GeometryHash, ChangesWithEveryPart) {
  const FileMesh mesh =
      parse_model("STNOFF 3 1 0\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n3 0 1 2\n", "m")
          .mesh;
  const Hash128 hash = geometry_hash(mesh);
  FileMesh changed = mesh;
  changed.positions[2].y = 1.0000001;
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
  Mesh swapped = in_floats(mesh);
  EXPECT_EQ(geometry_hash(swapped), hash);
  std::swap(swapped.positions, swapped.normals);
  EXPECT_NE(geometry_hash(swapped), hash);
}

TEST(GeometryHash, HoldsBesidePlacesWhatIsAskedFor) {
  const std::string file =
      "STNOFF 3 1 0\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n3 0 1 2\n";
  const FileMesh mesh = parse_model(file, "m").mesh;
  FileMesh other = mesh;
  other.uvs[0].x = 0.5F;
  EXPECT_EQ(geometry_hash(other, MeshExtras{}), geometry_hash(mesh, MeshExtras{}));
  EXPECT_EQ(geometry_hash(other, {false, true}), geometry_hash(mesh, {false, true}));
  EXPECT_NE(geometry_hash(other, {true, false}), geometry_hash(mesh, {true, false}));
  other = mesh;
  other.colors.assign(3, {1, 0, 0, 1});
  EXPECT_EQ(geometry_hash(other, {true, false}), geometry_hash(mesh, {true, false}));
  EXPECT_NE(geometry_hash(other, {false, true}), geometry_hash(mesh, {false, true}));
  // A mesh that has none is the same mesh, whatever is asked for.
  FileMesh bare = mesh;
  bare.uvs.clear();
  bare.normals.clear();
  EXPECT_EQ(geometry_hash(bare, MeshExtras{}), geometry_hash(mesh, MeshExtras{}));
  EXPECT_EQ(geometry_hash(bare), geometry_hash(bare, MeshExtras{}));
  other = mesh;
  other.normals[0] = {1, 0, 0};
  EXPECT_EQ(geometry_hash(other, {true, true}), geometry_hash(mesh, {true, true}));
  EXPECT_NE(geometry_hash(other, {.normals = true}), geometry_hash(mesh, {.normals = true}));
}

TEST(MeshHashes, EachIsOfItsPart) {
  const std::string file =
      "STNOFF 3 1 0\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n3 0 1 2\n";
  const FileMesh mesh = parse_model(file, "m").mesh;
  const MeshHashes hashes = mesh_hashes(mesh);
  EXPECT_EQ(hashes.shape, geometry_hash(mesh, MeshExtras{}));
  EXPECT_NE(hashes.uvs, Hash128{});
  EXPECT_EQ(hashes.colors, Hash128{});
  FileMesh other = mesh;
  other.uvs[0].x = 0.5F;
  EXPECT_EQ(mesh_hashes(other).shape, hashes.shape);
  EXPECT_NE(mesh_hashes(other).uvs, hashes.uvs);
  other = mesh;
  other.colors.assign(3, {1, 0, 0, 1});
  EXPECT_EQ(mesh_hashes(other).shape, hashes.shape);
  EXPECT_NE(mesh_hashes(other).colors, Hash128{});
  other = mesh;
  other.normals[0] = {1, 0, 0};
  EXPECT_EQ(mesh_hashes(other).shape, hashes.shape);
  EXPECT_NE(mesh_hashes(other).normals, hashes.normals);
}

TEST(GeometryHash, IsTheSameOnEveryMachine) {
  // The value a first run gave: a change here makes every dataset stale.
  EXPECT_EQ(hash_of(k_tetra_off).hex(), "4ccb2b2ab92b69a6fe192b421ff72c0e");
}

}  // namespace
}  // namespace ds
