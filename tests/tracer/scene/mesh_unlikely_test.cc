// SPDX-License-Identifier: Apache-2.0
// Files that are read and that hardly mean what they say: names in capitals and given twice, colours
// of another range, normals of no length, indices that count from 1.
#include "tests/tracer/scene/mesh_samples.h"

namespace ds {
namespace {

using samples::error_of;
using samples::k_tetra_off;
using samples::k_tetra_ply;
using samples::replaced;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

/// A triangle whose vertices have further properties, "float nx" and so on, and these values of each.
Model triangle(const std::vector<std::string>& properties, const std::string& values,
               const std::string& face = "", const std::string& face_values = "") {
  std::string head;
  for (const std::string& property : properties)
    head += "property " + property + "\n";
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\n" +
      head + "element face 1\nproperty list uchar int vertex_index\n" + face + "end_header\n";
  for (const char* point : {"0 0 0", "1 0 0", "0 1 0"})
    text += fmt::format("{} {}\n", point, values);
  return parse_model(text + "3 0 1 2 " + face_values + "\n", "m");
}
MendedDamage unlikely(const Model& model) {
  return unlikely_properties(model.report);
}

TEST(PlyNames, MayBeInCapitals) {
  const Model model = triangle({"float NX", "float Ny", "float NZ", "float U", "float V",
                                "uchar Red", "uchar Green", "uchar Blue", "uchar Alpha"},
                               "0 0 1 0.5 0.25 255 0 51 102");
  EXPECT_THAT(unlikely(model), IsEmpty());
  ASSERT_EQ(model.mesh.normals.size(), 3U);
  EXPECT_EQ(model.mesh.normals[2], (Vec3{0, 0, 1}));
  EXPECT_EQ(model.mesh.uvs, std::vector(3, Vec2{0.5F, 0.25F}));
  EXPECT_EQ(model.mesh.colors, std::vector(3, MeshColor{1, 0, 0.2F, 0.4F}));
  std::string tetra = replaced(k_tetra_ply, "float x", "float X");
  tetra = replaced(replaced(tetra, "element vertex", "element Vertex"), "vertex_indices",
                   "Vertex_Indices");
  samples::expect_tetra(parse_model(replaced(tetra, "element face", "element FACE"), "m").mesh);
  EXPECT_THAT(error_of(replaced(k_tetra_ply, "element face 4",
                                "element FACE 0\nproperty list uchar int vertex_indices\n"
                                "element face 4")),
              HasSubstr("has 2 elements face"));
}

TEST(PlyNames, TheFirstWholeOneOfTwoCounts) {
  const Model uvs = triangle({"float s", "float t", "float u", "float v"}, "0.125 0.25 0.5 0.75");
  EXPECT_EQ(uvs.mesh.uvs, std::vector(3, Vec2{0.125F, 0.25F}));
  EXPECT_THAT(unlikely(uvs), ElementsAre(Pair("unused_uvs", 2)));
  const Model colors = triangle({"uchar diffuse_red", "uchar diffuse_green", "uchar diffuse_blue",
                                 "uchar red", "uchar green", "uchar blue"},
                                "255 0 0 0 255 0");
  EXPECT_EQ(colors.mesh.colors, std::vector(3, MeshColor{1, 0, 0, 1}));
  EXPECT_THAT(unlikely(colors), ElementsAre(Pair("unused_colors", 3)));
  // Halves of two are not put together.
  const Model halves =
      triangle({"float s", "float texture_u", "float texture_v"}, "0.125 0.5 0.75");
  EXPECT_EQ(halves.mesh.uvs, std::vector(3, Vec2{0.5F, 0.75F}));
  EXPECT_THAT(unlikely(halves), IsEmpty()) << "one letter may mean anything";
  const Model twice = triangle({"float u", "float v", "float U"}, "0.5 0.75 0.125");
  EXPECT_EQ(twice.mesh.uvs, std::vector(3, Vec2{0.5F, 0.75F}));
  EXPECT_THAT(unlikely(twice), ElementsAre(Pair("unused_uvs", 1)));
  const Model places = triangle({"float X"}, "7");
  EXPECT_EQ(places.mesh.positions[1].x, 1);
  EXPECT_THAT(to_text(mended_damage(places.report)), HasSubstr("mean x, y or z not read: 1"));
}

TEST(PlyNames, WhatIsNotWholeIsCounted) {
  EXPECT_THAT(unlikely(triangle({"uchar red", "uchar green"}, "255 0")),
              ElementsAre(Pair("unused_colors", 2)));
  EXPECT_THAT(unlikely(triangle({"float nx", "float ny"}, "1 0")),
              ElementsAre(Pair("unused_normals", 2)));
}

TEST(PlyNames, VerticesColoursGoBeforeFacesAndCornersUvsBeforeVertices) {
  const std::string rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const Model colors =
      triangle({"uchar red", "uchar green", "uchar blue"}, "255 0 0", rgb, "0 255 0");
  EXPECT_EQ(colors.mesh.colors, std::vector(3, MeshColor{1, 0, 0, 1}));
  EXPECT_THAT(unlikely(colors), ElementsAre(Pair("unused_colors", 3)));
  const Model uvs = triangle({"float u", "float v"}, "0.5 0.5",
                             "property list uchar float texcoord\n", "6 0 0 1 0 0 1");
  EXPECT_EQ(uvs.mesh.uvs[1], (Vec2{1, 0}));
  EXPECT_THAT(unlikely(uvs), ElementsAre(Pair("unused_uvs", 2)));
}

TEST(MissingParts, UvsAndColoursThatOthersHaveAreCounted) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
      "z\n"
      "element face 3\nproperty list uchar int vertex_index\nproperty list uchar float texcoord\n"
      "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const auto uvs = [&](const char* faces) { return unlikely(parse_model(head + faces, "m")); };
  EXPECT_THAT(uvs("3 0 1 2 0\n3 0 1 3 6 0 0 1 0 0 1\n3 0 2 3 0\n"),
              ElementsAre(Pair("missing_uvs", 6)));
  EXPECT_THAT(uvs("3 0 1 2 0\n3 0 1 3 0\n3 0 2 3 0\n"), IsEmpty()) << "none has one";
  EXPECT_THAT(unlikely(parse_model(replaced(k_tetra_off, "3 0 2 1", "3 0 2 1 255 0 9"), "m")),
              ElementsAre(Pair("missing_colors", 3)));
}

TEST(UnlikelyColours, SharesStoredAsIntegers) {
  const std::vector<std::string> rgb{"uchar red", "uchar green", "uchar blue"};
  EXPECT_THAT(unlikely(triangle(rgb, "1 0 1")), ElementsAre(Pair("dark_colors", 3)));
  EXPECT_THAT(unlikely(triangle(rgb, "2 0 1")), IsEmpty());
  EXPECT_THAT(unlikely(triangle(rgb, "0 0 0")), IsEmpty()) << "black";
  EXPECT_THAT(unlikely(triangle({"ushort red", "ushort green", "ushort blue"}, "255 0 80")),
              ElementsAre(Pair("dark_colors", 3)));
  EXPECT_THAT(unlikely(triangle({"ushort red", "ushort green", "ushort blue"}, "300 0 80")),
              IsEmpty());
  EXPECT_THAT(unlikely(triangle({"float red", "float green", "float blue"}, "0.001 0 0")),
              IsEmpty());
  EXPECT_THAT(unlikely(triangle({"int red", "int green", "int blue"}, "1 0 1")), IsEmpty())
      << "read as 0 .. 1";
  EXPECT_THAT(
      unlikely(triangle({"uchar red", "uchar green", "uchar blue", "uchar alpha"}, "200 100 50 1")),
      ElementsAre(Pair("dark_colors", 3)));
  EXPECT_THAT(unlikely(triangle({}, "",
                                "property uchar red\nproperty uchar green\nproperty uchar "
                                "blue\n",
                                "1 1 0")),
              ElementsAre(Pair("dark_colors", 1)));
}

TEST(UnlikelyColours, BelowZeroAndAboveOne) {
  const std::vector<std::string> rgb{"float red", "float green", "float blue"};
  const Model below = triangle(rgb, "-0.5 0.5 1");
  EXPECT_EQ(below.mesh.colors[0], (MeshColor{0, 0.5F, 1, 1}));
  EXPECT_THAT(unlikely(below), ElementsAre(Pair("negative_colors", 3)));
  const Model above = triangle(rgb, "1.5 0.5 0");
  EXPECT_EQ(above.mesh.colors[0], (MeshColor{1.5F, 0.5F, 0, 1}));
  EXPECT_THAT(unlikely(above), ElementsAre(Pair("bright_colors", 3)));
  EXPECT_THAT(unlikely(triangle(rgb, "1.00001 0.5 0")), IsEmpty()) << "rounding";
  EXPECT_THAT(unlikely(triangle(rgb, "255 127.5 0")), IsEmpty());
  std::string off = replaced(k_tetra_off, "OFF", "COFF");
  for (const char* point : {"\n0 0 0", "\n4 0 0", "\n0 4 0", "\n0 0 4"})
    off = replaced(off, point, fmt::format("{} -1 0.5 1", point));
  EXPECT_THAT(unlikely(parse_model(off, "m")), ElementsAre(Pair("negative_colors", 4)));
}

TEST(UnlikelyNormals, OfNoLength) {
  EXPECT_THAT(unlikely(triangle({"float nx", "float ny", "float nz"}, "0 0 0")),
              ElementsAre(Pair("zero_normals", 3)));
  EXPECT_THAT(unlikely(triangle({"float nx", "float ny", "float nz"}, "0 0 1e-30")), IsEmpty());
}

TEST(Indices, ThatCountFromOneAreRefused) {
  const char* const wanted =
      "m: its faces' indices run from 1 to 4, the number of its vertices: they must count from 0";
  const std::string from_one = "3 1 3 2\n3 1 2 4\n3 1 4 3\n3 2 3 4\n";
  EXPECT_THAT(error_of("OFF\n4 4 6\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n" + from_one), HasSubstr(wanted));
  const std::string ply = k_tetra_ply;
  EXPECT_THAT(error_of(ply.substr(0, ply.size() - 4 * 8) + from_one), HasSubstr(wanted));
  // A vertex that no face uses and one wrong index are damage.
  const Model model =
      parse_model("OFF\n4 2 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n3 1 2 3\n3 1 2 9\n", "m");
  EXPECT_EQ(model.report.out_of_range, 1U);
}

}  // namespace
}  // namespace ds
