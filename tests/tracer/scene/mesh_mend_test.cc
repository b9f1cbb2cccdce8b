// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/mesh_samples.h"

#include <cmath>

namespace ds {
namespace {

using samples::error_of;
using samples::expect_tetra;
using samples::k_tetra_off;

/// An OFF file of the tetrahedron with more vertices and faces behind its own.
std::string tetra_and(const std::vector<std::string>& vertices,
                      const std::vector<std::string>& faces) {
  std::string file = fmt::format("OFF\n{} {} 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n", 4 + vertices.size(),
                                 4 + faces.size());
  for (const std::string& vertex : vertices)
    file += vertex + "\n";
  file += "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  for (const std::string& face : faces)
    file += face + "\n";
  return file;
}

TEST(Mend, LeavesASoundModelAlone) {
  const Model model = parse_model(k_tetra_off, "m");
  expect_tetra(model.mesh);
  const MeshReport& r = model.report;
  EXPECT_EQ(r.vertices, 4U);
  EXPECT_EQ(r.faces, 4U);
  EXPECT_EQ(r.triangles, 4U);
  EXPECT_EQ(r.triangles_kept, 4U);
  EXPECT_EQ(r.n_gons + r.short_faces + r.out_of_range + r.non_finite + r.bad_attributes +
                r.zero_area + r.duplicate_faces + r.unreferenced + r.flipped + r.against,
            0U);
}

TEST(Mend, RemovesFacesOfVerticesThatAreNotFinite) {
  for (const char* bad : {"nan 0 0", "0 -inf 0", "0 0 1e400", "0 0 3e38", "0 -1.1e18 0"}) {
    const Model model = parse_model(tetra_and({bad}, {"3 0 1 4", "4 0 1 2 4"}), "m");
    expect_tetra(model.mesh);
    EXPECT_EQ(model.report.non_finite, 1U) << bad;
    EXPECT_EQ(model.report.triangles, 7U);
    EXPECT_EQ(model.report.unreferenced, 1U);
  }
  EXPECT_EQ(parse_model(tetra_and({"0 0 -1e18"}, {"3 0 1 4"}), "m").report.non_finite, 0U);
}

TEST(Mend, RemovesFacesWithIndicesOutOfRange) {
  const Model model = parse_model(tetra_and({}, {"3 0 1 4", "3 -1 1 2", "4 0 1 2 4000000000",
                                                 "3 0 1 99999999999999999999", "3 0 1 2.5"}),
                                  "m");
  expect_tetra(model.mesh);
  EXPECT_EQ(model.report.out_of_range, 5U);
  EXPECT_EQ(model.report.triangles, 4U + 6U);
}

TEST(Mend, RemovesTrianglesWithoutArea) {
  const Model model = parse_model(
      tetra_and({"2 0 0", "0 0 0"}, {"3 0 1 1", "3 0 4 1", "3 0 5 1", "4 0 0 0 0"}), "m");
  expect_tetra(model.mesh);
  EXPECT_EQ(model.report.zero_area, 5U);
}

TEST(Mend, KeepsSlivers) {
  // A millionth of the length high: thin, but floats can tell it from a line.
  EXPECT_EQ(parse_model(tetra_and({"2 1e-6 0"}, {"3 0 1 4"}), "m").report.zero_area, 0U);
  EXPECT_EQ(
      parse_model("OFF 3 1 0\n0 0 0\n1e-30 0 0\n0 1e-30 0\n3 0 1 2\n", "m").report.triangles_kept,
      1U);
}

TEST(Mend, RemovesDuplicatesWhateverTheirOrder) {
  // Rotated, turned over, and between other vertices at the same places.
  const Model model = parse_model(
      tetra_and({"0 0 0", "4 0 0", "-0 4 -0"}, {"3 2 1 0", "3 0 1 2", "3 4 6 5", "3 4 1 6"}), "m");
  expect_tetra(model.mesh);
  EXPECT_EQ(model.report.duplicate_faces, 4U);
  EXPECT_EQ(model.report.unreferenced, 3U);
}

TEST(Mend, DropsVerticesNothingUsesInOrder) {
  const Model model =
      parse_model("OFF 6 1 0\n9 9 9\n1 0 0\n8 8 8\n0 1 0\n0 0 1\n7 7 7\n3 4 1 3\n", "m");
  EXPECT_EQ(model.mesh.positions, (std::vector<Vec3d>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(model.mesh.triangles, (samples::Triangles{{2, 0, 1}}));
  EXPECT_EQ(model.report.unreferenced, 3U);
}

TEST(Mend, CountsShortFacesAndNGons) {
  const Model model = parse_model(tetra_and({"4 4 0"}, {"0", "1 0", "2 0 1", "4 0 1 4 2"}), "m");
  EXPECT_EQ(model.report.short_faces, 3U);
  EXPECT_EQ(model.report.n_gons, 1U);
  EXPECT_EQ(model.report.triangles, 6U);
}

TEST(Mend, TurnsFlippedTrianglesAcrossDuplicatedVertices) {
  // The third face turned over, its corners written as vertices of their own.
  const Model model = parse_model(
      "OFF 7 4 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n0 0 0\n0 0 4\n0 4 0\n"
      "3 0 2 1\n3 0 1 3\n3 4 6 5\n3 1 2 3\n",
      "m");
  EXPECT_EQ(model.report.flipped, 1U);
  EXPECT_EQ(model.mesh.triangles[2], (std::array<std::uint32_t, 3>{4, 5, 6}));
}

TEST(Mend, ReplacesBadNormalsAndUvsByZero) {
  const Model model = parse_model(
      "STNOFF 3 1 0\n0 0 0 nan 0 0 0 0\n1 0 0 0 0 9 inf 0\n"
      "0 1 0 0 0 0 0.5 1\n3 0 1 2\n",
      "m");
  EXPECT_EQ(model.report.bad_attributes, 2U);
  EXPECT_EQ(model.mesh.normals, (std::vector<Vec3>{{0, 0, 0}, {0, 0, 1}, {0, 0, 0}}));
  EXPECT_EQ(model.mesh.uvs, (std::vector<Vec2>{{0, 0}, {0, 0}, {0.5F, 1}}));
}

TEST(Mend, AModelWithoutTrianglesIsAnError) {
  EXPECT_THAT(error_of("OFF 0 0 0\n"), testing::HasSubstr("m: no triangle is left of 0 faces"));
  EXPECT_THAT(
      error_of("OFF 3 2 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n3 0 1 7\n"),
      testing::HasSubstr("of 2 faces: 0 short, 1 with an index out of range, 0 vertices not "
                         "finite, 1 triangles without area"));
}

TEST(MeshReport, NamesTheDamageThatWasMended) {
  EXPECT_EQ(mended_damage(parse_model(tetra_and({"4 4 0"}, {"4 0 1 4 2"}), "m").report),
            MendedDamage{})
      << "an n-gon and what is removed without loss are no damage";
  const Model damaged =
      parse_model(tetra_and({"3e38 0 0", "0 nan 0"}, {"3 0 1 4", "3 0 1 9", "2 0 1"}), "m");
  const MendedDamage damage = mended_damage(damaged.report);
  EXPECT_EQ(damage, (MendedDamage{{"short_faces", 1}, {"out_of_range", 1}, {"non_finite", 2}}));
  EXPECT_EQ(to_text(damage),
            "faces of fewer than three corners removed: 1, faces with an index out of range "
            "removed: 1, vertices not finite or beyond 1e18 removed with their faces: 2");
}

TEST(MeshReport, ColumnsNameEveryCount) {
  // has_normals and has_uvs are the only members that are not counts; the struct is padded to 8
  // bytes.
  EXPECT_EQ(k_mesh_report_columns.size() * sizeof(std::uint64_t) + 8, sizeof(MeshReport));
}

}  // namespace
}  // namespace ds
