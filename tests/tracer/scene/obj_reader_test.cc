// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/mesh_samples.h"

#include <cmath>

namespace ds {
namespace {

using samples::error_of;
using samples::expect_tetra;
using samples::k_tetra_obj;
using samples::replaced;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

constexpr const char* k_triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

Model read(const std::string& text) {
  return parse_model(text, "m");
}

TEST(ObjReader, TakesEveryLineEndCommentsBlankLinesAndJoinedOnes) {
  expect_tetra(read(k_tetra_obj).mesh);
  for (const char* eol : {"\r\n", "\r", " # comment 1 2\n", "\n# f 1 2 3\n", " \t\n\n",
                          "\n# it ends with a stroke \\\n"})
    expect_tetra(read(replaced(k_tetra_obj, "\n", eol)).mesh);
  expect_tetra(read("\xef\xbb\xbf" + std::string(k_tetra_obj)).mesh);
  const std::string text = k_tetra_obj;
  expect_tetra(read(text.substr(0, text.size() - 1)).mesh);
  for (const char* joint : {" \\\n", "\\\n ", "\t\\\r\n\\\r\n ", " \\\r "})
    expect_tetra(read(replaced(replaced(k_tetra_obj, "f 1 2 4", "f 1 2" + std::string(joint) + "4"),
                               "v 4 0 0", "v" + std::string(joint) + "4 0 0"))
                     .mesh);
  EXPECT_THAT(error_of(replaced(k_tetra_obj, "f 1 2 4", "f 1 2\\\n 4\nv 1 2 x")),
              HasSubstr("m:8:"));
}

TEST(ObjReader, TakesEveryWayToWriteACorner) {
  const std::string rest = "vt 0 0\nvn 0 0 1\n";
  for (const char* corner : {"{}/1", "{}/1/1", "{}//1", "{}/1/", "{}//", "{}/"}) {
    std::string face = "f";
    for (int i = 1; i <= 3; ++i)
      face += " " + replaced(corner, "{}", std::to_string(i));
    const Model model = read(k_triangle + rest + face);
    EXPECT_EQ(model.mesh.triangles, (samples::Triangles{{0, 1, 2}})) << face;
    EXPECT_EQ(model.report.has_uvs, std::string(corner).starts_with("{}/1")) << face;
    EXPECT_EQ(model.report.has_normals,
              std::string(corner).ends_with("/1") && std::string(corner) != "{}/1")
        << face;
  }
  // Back from the last vertex there is so far.
  const Model back = read(std::string(k_triangle) + "f -3 -2 -1\nv 0 0 1\nf -1 -4 -3\n");
  EXPECT_EQ(back.mesh.triangles, (samples::Triangles{{0, 1, 2}, {3, 0, 1}}));
  // An index may lead on.
  EXPECT_EQ(read("f 3 1 2\n" + std::string(k_triangle)).mesh.triangles,
            (samples::Triangles{{2, 0, 1}}));
}

TEST(ObjReader, CornersHaveTheUvAndNormalTheirIndicesSay) {
  // Two triangles on one edge that share its places, and of one end the uv and normal too.
  const Model model = read(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
      "vt 0 0\nvt 1 0\nvt 1 1 0.5\nvt 0.25\n"
      "vn 0 0 2\nvn 0 1 0\n"
      "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/4/1 4/2/2\n");
  ASSERT_EQ(model.mesh.triangles.size(), 2U);
  const auto corner = [&](std::size_t t, std::size_t k) { return model.mesh.triangles[t][k]; };
  EXPECT_EQ(corner(0, 0), corner(1, 0)) << "corners that agree share a vertex";
  EXPECT_NE(corner(0, 2), corner(1, 1));
  EXPECT_EQ(model.mesh.positions.size(), 5U);
  const Vec2 uvs[2][3] = {{{0, 0}, {1, 0}, {1, 1}}, {{0, 0}, {0.25F, 0}, {1, 0}}};
  const Vec3d places[2][3] = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
  for (std::size_t t = 0; t < 2; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(model.mesh.positions[corner(t, k)], places[t][k]);
      EXPECT_EQ(model.mesh.uvs[corner(t, k)], uvs[t][k]);
      EXPECT_EQ(model.mesh.normals[corner(t, k)],
                (t == 1 && k == 2 ? Vec3{0, 1, 0} : Vec3{0, 0, 1}));
    }
  EXPECT_THAT(mended_damage(model.report), IsEmpty());
  EXPECT_THAT(unlikely_properties(model.report), IsEmpty());
}

TEST(ObjReader, CornersWithoutUvOrNormalAreCounted) {
  const Model model = read(std::string(k_triangle) +
                           "v 0 0 1\nvt 0.5 0.5\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1 2 4\n");
  EXPECT_THAT(unlikely_properties(model.report),
              ElementsAre(Pair("zero_normals", 3), Pair("missing_uvs", 3)));
}

TEST(ObjReader, UvsAndNormalsOfNoSuchNumberBecome0) {
  for (const char* corner : {"3/2/1", "3/0/1", "3/-2/1", "3/1/2", "3/1/0", "3/1/-2",
                             "3/99999999999999999999/1", "3/4294967296/1"}) {
    const Model model =
        read(std::string(k_triangle) + "vt 0.5 0.5\nvn 0 0 1\nf 1/1/1 2/1/1 " + corner + "\n");
    EXPECT_THAT(mended_damage(model.report), ElementsAre(Pair("bad_attributes", 1))) << corner;
    ASSERT_EQ(model.mesh.uvs.size(), 3U);
    EXPECT_TRUE(model.mesh.uvs[2] == Vec2{} || model.mesh.normals[2] == Vec3{}) << corner;
  }
}

TEST(ObjReader, FacesOfVerticesOfNoSuchNumberGo) {
  for (const char* face : {"1 2 4", "1 2 -4", "1 2 0", "1 2 4294967296", "1 2 4294967295",
                           "1 2 99999999999999999999", "1 2 -99999999999999999999"}) {
    const Model model = read(std::string(k_triangle) + "f 1 2 3\nf " + face + "\n");
    EXPECT_THAT(mended_damage(model.report), ElementsAre(Pair("out_of_range", 1))) << face;
    EXPECT_EQ(model.mesh.triangles.size(), 1U);
  }
  EXPECT_THAT(mended_damage(read(std::string(k_triangle) + "f 1 2 3\nf 1 2\nf 1\nf\n").report),
              ElementsAre(Pair("short_faces", 3)));
}

TEST(ObjReader, RefusesIndicesThatCountFrom0) {
  EXPECT_THAT(error_of(std::string(k_triangle) + "f 0 1 2\n"),
              HasSubstr("m: its faces' indices run from 0 to 2, one less than the number of its "
                        "vertices: they must count from 1"));
  EXPECT_EQ(read("v 9 9 9\n" + std::string(k_triangle) + "f 2 3 4\n").mesh.triangles.size(), 1U)
      << "what an OFF file is refused for";
}

TEST(ObjReader, ReadsColoursBehindPlaces) {
  const Model floats = read("v 0 0 0 1 0 0.5\nv 1 0 0 0 0 0\nv 0 1 0 0.25 1 1 0.5\nf 1 2 3\n");
  EXPECT_EQ(floats.mesh.colors,
            (std::vector<MeshColor>{{1, 0, 0.5F, 1}, {0, 0, 0, 1}, {0.25F, 1, 1, 0.5F}}));
  const Model bytes = read("v 0 0 0 1\nv 1 0 0 255 0 51\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(bytes.mesh.colors,
            (std::vector<MeshColor>{{1, 1, 1, 1}, {1, 0, 0.2F, 1}, {1, 1, 1, 1}}));
  EXPECT_THAT(unlikely_properties(bytes.report), ElementsAre(Pair("missing_colors", 2)));
}

TEST(ObjReader, CountsWhatItPassesOver) {
  const std::string plain = std::string(k_triangle) + "f 1 2 3\n";
  const auto counts = [&](const std::string& before, const std::string& behind = "") {
    const Model model = read(before + plain + behind);
    EXPECT_EQ(model.mesh.triangles.size(), 1U);
    MendedDamage all = mended_damage(model.report);
    for (const auto& one : unlikely_properties(model.report))
      all.push_back(one);
    return all;
  };
  EXPECT_THAT(counts("mtllib not there.mtl\no a name\ng a b\ns off\ns 1\n"), IsEmpty());
  EXPECT_THAT(counts("usemtl red\nusemtl a # b\n", "usemtl red\nusemtl\n"),
              ElementsAre(Pair("unused_materials", 2)));
  EXPECT_THAT(counts("", "l 1 2 \\\n 3\np 1\ncurv 0 1 1 2\n"),
              ElementsAre(Pair("unused_elements", 3)));
  EXPECT_THAT(counts("cstype rat bspline\ndeg 3 3\n", "surf 0 1 0 1 1 2 3\nparm u 0 1\nend\n"),
              ElementsAre(Pair("unused_surfaces", 1)));
  EXPECT_TRUE(loses_faces({{"unused_surfaces", 1}}));
  EXPECT_THAT(counts("o a\n", "V 1 2 3\ncall other.obj\n\x01\n"),
              ElementsAre(Pair("unknown_lines", 3)));
}

TEST(ObjReader, NamesTheLineOfWhatIsBroken) {
  const auto broken = [&](const char* from, const char* to) {
    return error_of(replaced(k_tetra_obj, from, to));
  };
  EXPECT_THAT(broken("v 4 0 0", "v 4 0"), HasSubstr("m:2: a vertex must have 3, 4, 6 or 7 values"));
  EXPECT_THAT(broken("v 4 0 0", "v 4 0 0 1 1"), HasSubstr("m:2: a vertex must have"));
  EXPECT_THAT(broken("v 4 0 0", "v 4 0 0 1 1 1 1 1"), HasSubstr("found 8"));
  EXPECT_THAT(broken("v 4 0 0", "v 4 0 zero"), HasSubstr("m:2: wanted a number, found \"zero\""));
  EXPECT_THAT(broken("v 4 0 0", "v 4 0 0x1"), HasSubstr("m:2: wanted a number, found \"0x1\""));
  EXPECT_THAT(broken("v 4 0 0", "v 4 0 0\nvt"),
              HasSubstr("m:3: a texture vertex must have 1 to 3"));
  EXPECT_THAT(broken("v 4 0 0", "v 4 0 0\nvn 1 2"), HasSubstr("m:3: a normal must have 3 values"));
  for (const char* corner : {"x", "/1", "1.5", "1/a", "1/1/1/1", "1,", "1-"})
    EXPECT_THAT(broken("f 1 2 4", fmt::format("f 1 2 {}", corner).c_str()),
                HasSubstr(fmt::format("m:6: wanted a corner (V, V/VT, V//VN or V/VT/VN), found "
                                      "\"{}\"",
                                      corner)));
  EXPECT_THAT(error_of("v 0 0 0\n"), HasSubstr("no triangle is left of 0 faces"));
}

TEST(ObjReader, KeepsTheDigitsOfFarPlaces) {
  const Model model = read(
      "v 5678901.234 4123456.789 0.1\nv 5678902.234 4123456.789 0.1\n"
      "v 5678901.234 4123457.789 0.1\nf 1 2 3\n");
  EXPECT_EQ(model.mesh.positions[0], (Vec3d{5678901.234, 4123456.789, 0.1}));
}

TEST(ObjReader, DamagedNumbersAreMendedAsInOtherFormats) {
  const Model model = read(std::string(k_triangle) + "v nan 0 0\nv 0 0 -inf\nv 1e999 0 0\n" +
                           "vt nan 0\nf 1/1 2/1 3/1\nf 1 2 4\nf 1 2 5\nf 1 2 6\n");
  EXPECT_THAT(mended_damage(model.report),
              ElementsAre(Pair("non_finite", 3), Pair("bad_attributes", 3)));
}

TEST(ObjReader, HasNoLimitToAFacesCorners) {
  // A circle of a million corners: its area is that of the regular polygon.
  constexpr int k_corners = 1'000'000;
  std::string text, face = "f";
  for (int i = 0; i < k_corners; ++i) {
    const double a = 2 * 3.14159265358979323846 * i / k_corners;
    text += fmt::format("v {:.17g} {:.17g} 0\n", std::cos(a), std::sin(a));
    face += fmt::format(" {}", i + 1);
  }
  const Model model = read(text + face);
  EXPECT_EQ(model.report.triangles, k_corners - 2U);
}

}  // namespace
}  // namespace ds
