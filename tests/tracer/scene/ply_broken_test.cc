// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/mesh_samples.h"

namespace ds {
namespace {

using samples::error_of;
using samples::k_tetra_ply;
using samples::put;
using samples::replaced;
using testing::HasSubstr;

std::string broken(const char* from, const char* to) {
  const std::string file = replaced(k_tetra_ply, from, to);
  EXPECT_NE(file, k_tetra_ply) << from;
  return error_of(file);
}

TEST(PlyHeader, NamesTheLineOfWhatIsBroken) {
  EXPECT_THAT(
      broken("format ascii", "format text"),
      HasSubstr(
          "m:2: format must be ascii, binary_little_endian or binary_big_endian, got \"text\""));
  EXPECT_THAT(broken("1.0", "2.0"), HasSubstr("m:2: version must be 1.0, got \"2.0\""));
  EXPECT_THAT(broken("format ascii 1.0\n", ""), HasSubstr("end_header before a format line"));
  EXPECT_THAT(broken("format ascii 1.0\n", "format ascii 1.0\nformat ascii 1.0\n"),
              HasSubstr("m:3: a second format line"));
  EXPECT_THAT(
      broken("vertex 4", "vertex -4"),
      HasSubstr("m:3: count of element vertex must be an integer of at least 0, got \"-4\""));
  EXPECT_THAT(broken("vertex 4", "vertex"), HasSubstr("m:3: count of element vertex"));
  EXPECT_THAT(broken("vertex 4", "vertex 99999999999999999999"),
              HasSubstr("m:3: count of element vertex"));
  EXPECT_THAT(broken("property float y", "property half y"),
              HasSubstr("m:5: unknown type \"half\""));
  EXPECT_THAT(broken("property float y", "property float x"),
              HasSubstr("m:5: a second property x of element vertex"));
  EXPECT_THAT(broken("property float y", "property float q"),
              HasSubstr("m:3: element vertex must have numbers x, y and z, found no y"));
  EXPECT_THAT(broken("property float y", "property float y y"),
              HasSubstr("m:5: wanted the end of the line, found \"y\""));
  EXPECT_THAT(broken("property float y", "properties"),
              HasSubstr("m:5: unknown header keyword \"properties\""));
  EXPECT_THAT(broken("element vertex 4\n", ""),
              HasSubstr("m:3: a property before the first element"));
  EXPECT_THAT(broken("element face", "element vertex"), HasSubstr("m:7: a second element vertex"));
  EXPECT_THAT(broken("element face", "element faces"), HasSubstr("m: has no element face"));
  EXPECT_THAT(broken("list uchar", "list float"),
              HasSubstr("m:8: the count of a list must have an integer type"));
  EXPECT_THAT(broken("vertex_indices", "corners"),
              HasSubstr("m:7: element face must have a list vertex_index or vertex_indices"));
  EXPECT_THAT(broken("end_header\n", "property list uchar int vertex_index\nend_header\n"),
              HasSubstr("both vertex_index and vertex_indices"));
  EXPECT_THAT(broken("end_header", "end"), HasSubstr("m:9: unknown header keyword \"end\""));
  EXPECT_THAT(error_of("ply\nformat ascii 1.0\n"), HasSubstr("cut off in the header"));
}

TEST(PlyText, NamesTheLineOfWhatIsBroken) {
  EXPECT_THAT(broken("vertex 4", "vertex 5"),
              HasSubstr("m:14: more values than element vertex has properties"));
  EXPECT_THAT(broken("vertex 4", "vertex 3"), HasSubstr("m:13: more values than element face has"));
  EXPECT_THAT(broken("vertex 4", "vertex 4000000000"),
              HasSubstr("m:14: more values than element vertex has"));
  EXPECT_THAT(broken("face 4", "face 4000000000"),
              HasSubstr("cut off: the header promises 4000000000 of element face, found 4"));
  EXPECT_THAT(broken("face 4", "face 3"), HasSubstr("m:17: text behind the last element"));
  EXPECT_THAT(broken("0 4 0\n", "0 4\n"), HasSubstr("m:12: fewer values than element vertex has"));
  EXPECT_THAT(broken("0 4 0\n", "0 4 none\n"), HasSubstr("m:12: wanted a number, found \"none\""));
  EXPECT_THAT(broken("3 0 1 3", "3.5 0 1 3"), HasSubstr("m:15: wanted an integer, found \"3.5\""));
  EXPECT_THAT(broken("3 0 1 3", "-3 0 1 3"), HasSubstr("m:15: a list of -3 values"));
  EXPECT_THAT(broken("3 0 1 3", "4 0 1 3"), HasSubstr("m:15: fewer values than element face has"));
  EXPECT_THAT(broken("3 0 1 3", "2 0 1 3"),
              HasSubstr("m:15: more values than element face has properties"));
}

/// The tetrahedron with the given counts in its header; the body always holds four of each.
std::string binary_tetra(const char* vertices = "4", const char* faces = "4") {
  std::string file = fmt::format(
      "ply\nformat binary_big_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nelement face {}\nproperty list int int vertex_index\nend_header\n",
      vertices, faces);
  for (const Vec3d p : samples::k_tetra_positions)
    for (const double x : {p.x, p.y, p.z})
      put<float>(file, x, std::endian::big);
  for (const auto& t : samples::k_tetra_triangles) {
    put<std::int32_t>(file, 3, std::endian::big);
    for (const std::uint32_t v : t)
      put<std::int32_t>(file, v, std::endian::big);
  }
  return file;
}

TEST(PlyBinary, NamesTheByteOfWhatIsBroken) {
  const std::string whole = binary_tetra();
  samples::expect_tetra(parse_model(whole, "m").mesh);
  samples::expect_tetra(parse_model(whole + "\r\n", "m").mesh);
  EXPECT_EQ(error_of(whole.substr(0, whole.size() - 1)),
            fmt::format("m: byte {}: cut off in element face number 4 of 4", whole.size() - 1));
  EXPECT_THAT(error_of(binary_tetra("4000000000")), HasSubstr("of 4000000000"));
  EXPECT_THAT(error_of(binary_tetra("18446744073709551615")),
              HasSubstr("cut off in element vertex"));
  EXPECT_THAT(error_of(binary_tetra("4", "4000000000")),
              HasSubstr("cut off in element face number 5 of 4000000000"));
  std::string negative = whole;
  negative[whole.size() - 64] = '\xff';
  EXPECT_THAT(error_of(negative),
              testing::StartsWith(fmt::format("m: byte {}: a list of -", whole.size() - 64)));
  std::string huge = whole;
  huge[whole.size() - 64] = '\x7f';
  EXPECT_THAT(error_of(huge), HasSubstr("cut off in element face number 1 of 4"));
}

TEST(PlyBinary, EveryCutIsAnError) {
  const std::string whole = binary_tetra();
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(parse_model(whole.substr(0, size), "m"), Error) << size;
}

TEST(PlyText, EveryCutIsAnError) {
  const std::string whole = k_tetra_ply;
  for (std::size_t size = 0; size + 2 < whole.size(); ++size)
    EXPECT_THROW(parse_model(whole.substr(0, size), "m"), Error) << size;
}

TEST(PlyBinary, EveryChangedByteIsReadOrRefused) {
  // Nothing to compare with but that it ends, in bounds (this is built with checked containers
  // too).
  const std::string whole = binary_tetra();
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const char c : {'\x00', '\x01', '\x7f', '\x80', '\xff'}) {
      std::string changed = whole;
      changed[i] = c;
      try {
        const Model model = parse_model(changed, "m");
        for (const auto& t : model.mesh.triangles)
          for (const std::uint32_t v : t)
            EXPECT_LT(v, model.mesh.positions.size());
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::asset);
      }
    }
}

}  // namespace
}  // namespace ds
