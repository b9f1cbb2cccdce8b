// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/mesh_samples.h"

#include <bit>
#include <optional>
#include <tuple>

namespace ds {
namespace {

using samples::expect_tetra;
using samples::k_tetra_ply;
using samples::put;
using samples::replaced;
using testing::Combine;
using testing::Values;

// Every type under both its names, in every role and format.

struct Type {
  const char* name;
  void (*put)(std::string&, double, std::endian);
};
const Type k_types[] = {
    {"char", put<std::int8_t>},     {"int8", put<std::int8_t>},     {"uchar", put<std::uint8_t>},
    {"uint8", put<std::uint8_t>},   {"short", put<std::int16_t>},   {"int16", put<std::int16_t>},
    {"ushort", put<std::uint16_t>}, {"uint16", put<std::uint16_t>}, {"int", put<std::int32_t>},
    {"int32", put<std::int32_t>},   {"uint", put<std::uint32_t>},   {"uint32", put<std::uint32_t>},
    {"float", put<float>},          {"float32", put<float>},        {"double", put<double>},
    {"float64", put<double>},
};
constexpr int k_integer_types = 12;

struct Writer {
  std::optional<std::endian> order;  ///< nothing for ascii
  std::string body;

  void value(const Type& type, double v) {
    if (order)
      type.put(body, v, *order);
    else
      body += fmt::format("{} ", v);
  }
  void end() {
    if (!order) body += "\n";
  }
  std::string format() const {
    return !order                          ? "ascii"
           : *order == std::endian::little ? "binary_little_endian"
                                           : "binary_big_endian";
  }
};

/// The tetrahedron with things to skip before, between and behind what counts, on vertices and
/// faces, and elements that are none of either.
std::string tetra_with_extras(std::optional<std::endian> order, const Type& coordinate,
                              const Type& count, const Type& index, const std::string& list_name) {
  Writer out{order, {}};
  const Type &uchar = k_types[2], &number = k_types[12], &ushort = k_types[6];
  for (int i = 0; i < 2; ++i) {
    out.value(number, 0.5);
    out.value(count, 3);
    for (int k = 0; k < 3; ++k)
      out.value(ushort, k);
    out.end();
  }
  for (const Vec3d p : samples::k_tetra_positions) {
    out.value(coordinate, p.z);
    out.value(count, 2);
    out.value(number, 0.25);
    out.value(number, -7);
    out.value(coordinate, p.x);
    out.value(uchar, 200);
    out.value(coordinate, p.y);
    out.end();
  }
  for (const auto& t : samples::k_tetra_triangles) {
    out.value(uchar, 9);
    out.value(count, 3);
    for (const std::uint32_t v : t)
      out.value(index, v);
    out.value(count, 0);
    out.end();
  }
  out.value(number, 1);
  out.end();
  return fmt::format(
             "ply\nformat {} 1.0\ncomment element vertex 9\nobj_info made by hand\n"
             "element first 2\nproperty float a\nproperty list {} ushort b\n"
             "element vertex 4\nproperty {} z\nproperty list {} float weights\nproperty {} x\n"
             "property uchar red\nproperty {} y\nelement nothing 4000000000\n"
             "element face 4\nproperty uchar flags\nproperty list {} {} {}\n"
             "property list {} float texcoord\nelement last 1\nproperty float a\nend_header\n",
             out.format(), count.name, coordinate.name, count.name, coordinate.name,
             coordinate.name, count.name, index.name, list_name, count.name) +
         out.body;
}

using Flavour = std::tuple<int, int, int, int>;  // format, coordinate, count, index
class PlyFlavours : public testing::TestWithParam<Flavour> {};

TEST_P(PlyFlavours, GiveTheSameMesh) {
  const auto [format, coordinate, count, index] = GetParam();
  std::optional<std::endian> order;
  if (format == 1) order = std::endian::little;
  if (format == 2) order = std::endian::big;
  const std::string file =
      tetra_with_extras(order, k_types[coordinate], k_types[count], k_types[index],
                        index % 2 ? "vertex_index" : "vertex_indices");
  const Model model = parse_model(file, "m.ply");
  expect_tetra(model.mesh);
  EXPECT_EQ(model.report.vertices, 4U);
  EXPECT_EQ(model.report.faces, 4U);
  EXPECT_FALSE(model.report.has_normals);
}

INSTANTIATE_TEST_SUITE_P(Coordinates, PlyFlavours,
                         Combine(testing::Range(0, 3), testing::Range(0, 16), Values(2),
                                 Values(8)));
INSTANTIATE_TEST_SUITE_P(Counts, PlyFlavours,
                         Combine(testing::Range(0, 3), Values(12),
                                 testing::Range(0, k_integer_types), Values(8)));
INSTANTIATE_TEST_SUITE_P(Indices, PlyFlavours,
                         Combine(testing::Range(0, 3), Values(12), Values(2),
                                 testing::Range(0, 16)));

std::string vertex_file(const std::string& properties, const std::string& vertices) {
  return "ply\nformat ascii 1.0\nelement vertex 3\n" + properties +
         "element face 1\nproperty list uchar int vertex_index\nend_header\n" + vertices +
         "3 0 1 2\n";
}

TEST(PlyReader, TakesNormalsAndAllNamesOfTextureCoordinates) {
  const std::string vertices = "0 0 0 0 0 2 0.25 0.5\n1 0 0 0 0 2 1 0\n0 1 0 0 3 4 0 1\n";
  for (const auto& [u, v] :
       {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}) {
    const std::string properties = fmt::format(
        "property float x\nproperty float y\nproperty float z\nproperty float nx\n"
        "property float ny\nproperty float nz\nproperty float {}\nproperty float {}\n",
        u, v);
    const Model model = parse_model(vertex_file(properties, vertices), "m");
    EXPECT_EQ(model.mesh.normals, (std::vector<Vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0.6F, 0.8F}}));
    EXPECT_EQ(model.mesh.uvs, (std::vector<Vec2>{{0.25F, 0.5F}, {1, 0}, {0, 1}}));
    EXPECT_TRUE(model.report.has_normals);
    EXPECT_TRUE(model.report.has_uvs);
  }
}

TEST(PlyReader, HalfASetOfNormalsOrTextureCoordinatesIsNone) {
  const Model model =
      parse_model(vertex_file("property float x\nproperty float y\nproperty float z\n"
                              "property float nx\nproperty float ny\nproperty float u\n",
                              "0 0 0 1 2 3\n1 0 0 1 2 3\n0 1 0 1 2 3\n"),
                  "m");
  EXPECT_FALSE(model.report.has_normals);
  EXPECT_FALSE(model.report.has_uvs);
}

TEST(PlyReader, TakesEveryLineEnd) {
  expect_tetra(parse_model(replaced(k_tetra_ply, "\n", "\r\n"), "m").mesh);
  expect_tetra(parse_model(replaced(k_tetra_ply, "\n", "\r"), "m").mesh);
  expect_tetra(parse_model(replaced(k_tetra_ply, "3 0 2 1\n", "\n\t3\t0  2 1 \n \n"), "m").mesh);
  const std::string without_last_break = k_tetra_ply;
  expect_tetra(parse_model(without_last_break.substr(0, without_last_break.size() - 1), "m").mesh);
}

TEST(PlyReader, BinaryBodyMayBeginLikeALineBreak) {
  // A first coordinate whose first byte is '\n', behind a header of each line end.
  for (const char* eol : {"\n", "\r\n", "\r"}) {
    std::string file = replaced(
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar "
        "y\n"
        "property uchar z\nelement face 1\nproperty list uchar uchar vertex_index\nend_header\n",
        "\n", eol);
    file += std::string("\x0a\x00\x00\x0d\x01\x00\x00\x01\x02\x03\x00\x01\x02", 13);
    const Model model = parse_model(file, "m");
    EXPECT_EQ(model.mesh.positions, (std::vector<Vec3d>{{10, 0, 0}, {13, 1, 0}, {0, 1, 2}}));
  }
}

TEST(PlyReader, FacesMayComeBeforeVertices) {
  expect_tetra(parse_model("ply\nformat ascii 1.0\nelement face 4\n"
                           "property list uchar int vertex_indices\nelement vertex 4\n"
                           "property float x\nproperty float y\nproperty float z\nend_header\n"
                           "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n",
                           "m")
                   .mesh);
}

TEST(PlyReader, ReadsNumbersHoweverTheyAreSpelt) {
  expect_tetra(parse_model(replaced(k_tetra_ply, "4 0 0", "+4.0e+0 -0 0.e-300"), "m").mesh);
}

}  // namespace
}  // namespace ds
