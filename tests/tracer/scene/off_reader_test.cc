// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/mesh_samples.h"
#include "tracer/scene/mesh_formats.h"

namespace ds {
namespace {

using samples::error_of;
using samples::expect_tetra;
using samples::k_tetra_off;
using samples::replaced;
using testing::HasSubstr;

TEST(OffReader, ReadsTheHeaderInAllItsForms) {
  const std::string file = k_tetra_off;
  expect_tetra(parse_model(file, "m").mesh);
  for (const char* header : {"OFF 4 4 6", "OFF4 4 6", "OFF\t4\t4",
                             "# made\n\nOFF # here\n# and\n4 4 6 # so", "  OFF\n\n 4 4 0"})
    expect_tetra(parse_model(replaced(file, "OFF\n4 4 6", header), "m").mesh);
}

TEST(OffReader, TakesEveryLineEndCommentsAndBlankLines) {
  for (const char* eol : {"\r\n", "\r", " # comment 1 2\n", "\n# 1 2 3\n", " \t\n\n"})
    expect_tetra(parse_model(replaced(k_tetra_off, "\n", eol), "m").mesh);
}

TEST(OffReader, FaceColoursChangeNoTriangle) {
  for (const char* colour : {"7", "255 0 0", "0.1 0.2 0.3", "1 1 1 1"}) {
    const auto mesh =
        parse_model(replaced(k_tetra_off, "3 0 2 1", fmt::format("3 0 2 1 {}", colour)), "m").mesh;
    ASSERT_EQ(mesh.triangles.size(), 4U);
    for (std::size_t t = 0; t < 4; ++t)
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(mesh.positions[mesh.triangles[t][k]],
                  samples::k_tetra_positions[samples::k_tetra_triangles[t][k]]);
  }
}

struct Variant {
  const char* keyword;
  const char* extra;  ///< behind each vertex
  bool normals, uvs;
};
class OffVariants : public testing::TestWithParam<Variant> {};

TEST_P(OffVariants, AreRead) {
  const Variant v = GetParam();
  std::string file = replaced(k_tetra_off, "OFF", v.keyword);
  for (const char* vertex : {"\n0 0 0", "\n4 0 0", "\n0 4 0", "\n0 0 4"})
    file = replaced(file, vertex, fmt::format("{} {}", vertex, v.extra));
  const Model model = parse_model(file, "m");
  expect_tetra(model.mesh);
  EXPECT_EQ(model.report.has_normals, v.normals);
  EXPECT_EQ(model.report.has_uvs, v.uvs);
  EXPECT_EQ(model.mesh.normals, std::vector<Vec3>(v.normals ? 4 : 0, {0, 0, 1}));
  EXPECT_EQ(model.mesh.uvs, std::vector<Vec2>(v.uvs ? 4 : 0, {0.5F, 0.75F}));
}

INSTANTIATE_TEST_SUITE_P(All, OffVariants,
                         testing::Values(Variant{"COFF", "255 128 0", false, false},
                                         Variant{"COFF", "1 0.5 0 1", false, false},
                                         Variant{"NOFF", "0 0 2", true, false},
                                         Variant{"STOFF", "0.5 0.75", false, true},
                                         Variant{"CNOFF", "0 0 2 255 0 0 9", true, false},
                                         Variant{"NCOFF", "0 0 2 255 0 0", true, false},
                                         Variant{"STCOFF", "9 9 9 0.5 0.75", false, true},
                                         Variant{"STCOFF", "9 9 9 9 0.5 0.75", false, true},
                                         Variant{"STNOFF", "0 0 2 0.5 0.75", true, true},
                                         Variant{"STCNOFF", "0 0 2 9 9 9 0.5 0.75", true, true},
                                         Variant{"STCNOFF", "0 0 2 9 9 9 1 0.5 0.75", true, true}));

TEST(OffReader, TriangulatesPolygons) {
  const Model model = parse_model(samples::box_off(1, 2, 3), "m");
  EXPECT_EQ(model.report.n_gons, 6U);
  EXPECT_EQ(model.report.triangles, 12U);
  EXPECT_EQ(model.report.flipped, 0U);
}

TEST(OffReader, RefusesOtherDimensionsAndBinary) {
  for (const char* keyword : {"4OFF", "nOFF", "4nOFF", "STCN4OFF"})
    EXPECT_THAT(error_of(replaced(k_tetra_off, "OFF", keyword)),
                testing::StartsWith(fmt::format("m:1: {} is not supported", keyword)));
  EXPECT_THAT(error_of("OFF BINARY\nxxxx"), HasSubstr("m:1: OFF BINARY is not supported"));
}

TEST(OffReader, NamesTheLineOfWhatIsBroken) {
  const std::string file = k_tetra_off;
  const auto broken = [&](const char* from, const char* to) {
    return error_of(replaced(file, from, to));
  };
  EXPECT_THAT(broken("4 4 6", "5 4 6"), HasSubstr("m:7: vertex 4 must have 3 values, found more"));
  EXPECT_THAT(broken("4 4 6", "3 4 6"), HasSubstr("m:10: text behind the last face"));
  EXPECT_THAT(broken("4 4 6", "4 5 6"), HasSubstr("cut off: the header promises 5 faces, found 4"));
  EXPECT_THAT(broken("4 4 6", "4 3 6"), HasSubstr("m:10: text behind the last face"));
  EXPECT_THAT(broken("4 4 6", "4294967295 4 6"), HasSubstr("m:7: vertex 4 must have 3 values"));
  EXPECT_THAT(broken("4 4 6", "4 99999999999999999999 6"), HasSubstr("m:2: wanted an integer"));
  EXPECT_THAT(broken("4 4 6", "-4 4 6"),
              HasSubstr("m:2: the number of vertices must be at least 0, got -4"));
  EXPECT_THAT(broken("4 4 6", "4"), HasSubstr("m:2: wanted the number of faces, found nothing"));
  EXPECT_THAT(broken("4 4 6", "4 4 6 8"), HasSubstr("m:2: more than three counts"));
  EXPECT_THAT(broken("0 4 0", "0 4"), HasSubstr("m:5: vertex 2 must have 3 values, found fewer"));
  EXPECT_THAT(broken("0 4 0", "0 4 zero"), HasSubstr("m:5: wanted a number, found \"zero\""));
  EXPECT_THAT(broken("0 4 0", "0 4 0x1"), HasSubstr("m:5: wanted a number, found \"0x1\""));
  EXPECT_THAT(broken("3 0 1 3", "4000000000 0 1 3"),
              HasSubstr("m:8: face 1 must have 4000000000 corners, found 3"));
  EXPECT_THAT(broken("3 0 1 3", "-3 0 1 3"), HasSubstr("m:8: face 1 has -3 corners"));
  EXPECT_THAT(broken("3 0 1 3", "3 0 1 3 1 1 1 1 1"),
              HasSubstr("m:8: face 1 has more than 3 corners and a colour"));
}

TEST(OffReader, RefusesAVertexThatIsShorterThanTheColouredOnesBefore) {
  EXPECT_THAT(error_of("OFF\n3 1 0\n0 0 0 255 0 0 255\n1 255\n0 1 0\n3 0 1 2\n"),
              HasSubstr("m:4: vertex 1 must have 3 values, found fewer"));
}

TEST(OffReader, EveryCutIsAnError) {
  // Less the last digit the file would hold other numbers, and be whole; less the line break it is.
  const std::string file = k_tetra_off;
  for (std::size_t size = 0; size + 2 < file.size(); ++size)
    EXPECT_THROW(parse_model(file.substr(0, size), "m"), Error) << size;
}

TEST(OffReader, SaysWhatAFileOfAnotherKindBeginsWith) {
  const std::string wanted = "m: wanted a mesh file (" + mesh_format_names() + "), found ";
  EXPECT_THAT(wanted, HasSubstr("PLY"));
  EXPECT_EQ(error_of(""), wanted + "an empty one");
  EXPECT_EQ(error_of("GIF89a\n"), wanted + "one that begins \"GIF89a?\"");
  EXPECT_THAT(error_of("XOFF\n1 1 1\n"), HasSubstr(wanted));
}

}  // namespace
}  // namespace ds
