// SPDX-License-Identifier: Apache-2.0
// What files hold besides places: uv of corners, colours of vertices and faces; and files that are
// not written as most are.
#include "tests/tracer/scene/mesh_samples.h"

#include <map>

namespace ds {
namespace {

using samples::error_of;
using samples::expect_tetra;
using samples::k_tetra_off;
using samples::k_tetra_ply;
using samples::put;
using samples::replaced;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr MeshColor k_red{1, 0, 0, 1}, k_green{0, 1, 0, 1}, k_white{1, 1, 1, 1};

/// Two squares side by side that share an edge.
std::string squares(const std::string& vertex, const std::string& face, const std::string& body) {
  return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty "
         "float "
         "z\n" +
         vertex + "element face 2\nproperty list uchar int vertex_indices\n" + face +
         "end_header\n" + body;
}
const std::string k_points = "0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n2 1 0\n";

TEST(PlyReader, GivesCornersTheirOwnUv) {
  const std::string uv = " 8 0 0 1 0 1 1 0 1\n";
  const Model model = parse_model(squares("", "property list uchar float texcoord\n",
                                          k_points + "4 0 1 4 3" + uv + "4 1 2 5 4" + uv),
                                  "m");
  EXPECT_TRUE(model.report.has_uvs);
  EXPECT_EQ(model.report.vertices, 6U);
  ASSERT_EQ(model.mesh.positions.size(), 8U);  // two of the shared corners
  ASSERT_EQ(model.mesh.triangles.size(), 4U);
  for (const auto& triangle : model.mesh.triangles)
    for (const std::uint32_t v : triangle) {
      const bool second = &triangle >= &model.mesh.triangles[2];
      EXPECT_EQ(static_cast<double>(model.mesh.uvs[v].x),
                model.mesh.positions[v].x - (second ? 1 : 0));
      EXPECT_EQ(static_cast<double>(model.mesh.uvs[v].y), model.mesh.positions[v].y);
    }
}

TEST(PlyReader, TakesFacesWithoutTexcoordAndRefusesWrongCounts) {
  const auto with = [](const char* list) {
    return squares("", "property list uchar float texcoord\n",
                   k_points + "4 0 1 4 3 8 0 0 1 0 1 1 0 1\n4 1 2 5 4 " + list + "\n");
  };
  const Model model = parse_model(with("0"), "m");
  EXPECT_EQ(model.mesh.triangles.size(), 4U);
  EXPECT_EQ(model.mesh.uvs[model.mesh.triangles[3][2]], (Vec2{0, 0}));
  EXPECT_THAT(error_of(with("6 0 0 1 0 1 1")),
              HasSubstr("face 1 has 4 corners and 3 pairs of texcoord"));
  EXPECT_THAT(error_of(with("3 0 0 1")), HasSubstr("a face has 3 values of texcoord"));
}

/// The colour of a model's vertex at each x.
std::map<double, MeshColor> colors_by_x(const Model& model) {
  std::map<double, MeshColor> colors;
  for (std::size_t v = 0; v < model.mesh.positions.size(); ++v)
    colors[model.mesh.positions[v].x] = model.mesh.colors.at(v);
  return colors;
}

TEST(PlyReader, ReadsColoursOfVertices) {
  const std::string faces = "4 0 1 4 3\n4 1 2 5 4\n";
  for (const auto& [type, one] : {std::pair{"uchar", "255"},
                                  {"ushort", "65535"},
                                  {"float", "1"},
                                  {"int", "255"},
                                  {"double", "255"}})
    for (const char* alpha : {"", "alpha"}) {
      const bool has_alpha = *alpha != '\0';
      std::string head, body;
      for (const char* name : {"red", "green", "blue", alpha})
        if (*name != '\0') head += fmt::format("property {} {}\n", type, name);
      for (const char* point : {"0 0 0", "1 0 0", "2 0 0", "0 1 0", "1 1 0", "2 1 0"})
        body += fmt::format("{} {} {} 0{}\n", point, point[0] == '0' ? one : "0",
                            point[0] == '0' ? "0" : one, has_alpha ? " 0" : "");
      const Model model = parse_model(squares(head, "", body + faces), "m");
      EXPECT_TRUE(model.report.has_colors);
      const float a = has_alpha ? 0.0F : 1.0F;
      EXPECT_THAT(colors_by_x(model), ElementsAre(testing::Pair(0, MeshColor{1, 0, 0, a}),
                                                  testing::Pair(1, MeshColor{0, 1, 0, a}),
                                                  testing::Pair(2, MeshColor{0, 1, 0, a})))
          << type;
    }
}

TEST(PlyReader, ColoursWithoutARangeOfTheirTypeTellIt) {
  // What the first vertex' red and alpha are, for a file whose greatest value is `most`.
  const auto first = [](const char* type, const char* red, const char* most, const char* alpha) {
    std::string head, body;
    for (const char* name : {"red", "green", "blue", "alpha"})
      head += fmt::format("property {} {}\n", type, name);
    for (const char* point : {"0 0 0", "1 0 0", "2 0 0", "0 1 0", "1 1 0", "2 1 0"})
      body += fmt::format("{} {} 0 0 {}\n", point, point[0] == '0' ? red : most, alpha);
    const MeshColor c =
        colors_by_x(parse_model(squares(head, "", body + "4 0 1 4 3\n4 1 2 5 4\n"), "m")).at(0);
    return std::pair{c[0], c[3]};
  };
  // A little or much brighter than white, as floats may be, is no colour of 0 .. 255.
  EXPECT_EQ(first("float", "0.5", "1.00001", "1"), (std::pair{0.5F, 1.0F}));
  EXPECT_EQ(first("double", "0.5", "12.5", "1"), (std::pair{0.5F, 1.0F}));
  EXPECT_EQ(first("float", "51", "255", "0.25"), (std::pair{0.2F, 0.25F}));
  EXPECT_EQ(first("float", "25.5", "200.5", "255"), (std::pair{0.1F, 1.0F}));
  EXPECT_EQ(first("int", "1", "2", "51"), (std::pair{1 / 255.0F, 0.2F}));
  EXPECT_EQ(first("uint", "13107", "65535", "65535"), (std::pair{0.2F, 1.0F}));
  // What is no number is 0, alone.
  EXPECT_EQ(first("float", "0.5", "1", "nan"), (std::pair{0.5F, 0.0F}));
}

/// Of each triangle, which all three corners must have.
std::vector<MeshColor> triangle_colors(const Model& model) {
  std::vector<MeshColor> colors;
  for (const auto& t : model.mesh.triangles) {
    colors.push_back(model.mesh.colors.at(t[0]));
    EXPECT_EQ(model.mesh.colors.at(t[1]), colors.back());
    EXPECT_EQ(model.mesh.colors.at(t[2]), colors.back());
  }
  return colors;
}

TEST(PlyReader, ReadsColoursOfFaces) {
  const std::string names = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const Model model =
      parse_model(squares("", names, k_points + "4 0 1 4 3 255 0 0\n4 1 2 5 4 0 255 0\n"), "m");
  EXPECT_THAT(triangle_colors(model), ElementsAre(k_red, k_red, k_green, k_green));
  EXPECT_EQ(model.mesh.positions.size(), 8U);
}

TEST(PlyReader, ReadsStripsOfTriangles) {
  // Two squares as one strip, then one triangle; an index below 0 between.
  const Model model = parse_model(
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float "
      "z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
          k_points + "10 0 1 3 4 -1 1 2 4 -1 5\n",
      "m");
  EXPECT_EQ(model.report.out_of_range, 0U);
  EXPECT_THAT(model.mesh.triangles, ElementsAre(std::array<std::uint32_t, 3>{0, 1, 3},
                                                std::array<std::uint32_t, 3>{3, 1, 4},
                                                std::array<std::uint32_t, 3>{1, 2, 4}));
}

TEST(PlyReader, CountsBytesBehindTheLastElement) {
  std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float "
      "y\nproperty float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n";
  for (const float x : {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F})
    put<float>(binary, x, std::endian::little);
  put<std::uint8_t>(binary, 3, std::endian::little);
  for (const int v : {0, 1, 2})
    put<std::int32_t>(binary, v, std::endian::little);
  const Model model = parse_model(binary + "12345", "m");
  EXPECT_EQ(model.report.trailing_bytes, 5U);
  EXPECT_THAT(to_text(mended_damage(model.report)), HasSubstr("not read: 5"));
  EXPECT_EQ(parse_model(std::string(k_tetra_ply) + "the end\n", "m").report.trailing_bytes, 8U);
}

TEST(PlyReader, TakesAByteOrderMarkAndMixedLineEnds) {
  expect_tetra(parse_model("\xef\xbb\xbf" + std::string(k_tetra_ply), "m").mesh);
  const std::string file = k_tetra_ply;
  expect_tetra(parse_model(replaced(file, "ply\n", "ply \r\n"), "m").mesh);
  expect_tetra(parse_model(replaced(file, "ascii 1.0\n", "ascii 1.0\r\n"), "m").mesh);
  expect_tetra(parse_model(file.substr(0, file.size() - 1), "m").mesh);
  EXPECT_THAT(error_of("\xff\xfep\0l\0y\0"), HasSubstr("must be UTF-8, found UTF-16"));
}

TEST(OffReader, ReadsColours) {
  const std::string file = k_tetra_off;
  std::string vertices = replaced(file, "OFF", "COFF"), bytes = vertices, plain = file;
  for (const char* point : {"\n0 0 0", "\n4 0 0", "\n0 4 0", "\n0 0 4"}) {
    vertices = replaced(vertices, point, fmt::format("{} 0 0.5 1 0.25", point));
    bytes = replaced(bytes, point, fmt::format("{} 0 255 51", point));
    plain = replaced(plain, point, fmt::format("{} 0 255 51 255", point));
  }
  for (const auto& [text, color] : {std::pair{vertices, MeshColor{0, 0.5F, 1, 0.25F}},
                                    {bytes, MeshColor{0, 1, 0.2F, 1}},
                                    {plain, MeshColor{0, 1, 0.2F, 1}}}) {
    const Model model = parse_model(text, "m");
    expect_tetra(model.mesh);
    EXPECT_EQ(model.mesh.colors, std::vector(4, color));
  }
}

TEST(OffReader, ReadsColoursOfFaces) {
  const std::string file = replaced(replaced(k_tetra_off, "3 0 2 1", "3 0 2 1 255 0 0"), "3 0 3 2",
                                    "3 0 3 2 0 255 0 255");
  EXPECT_THAT(triangle_colors(parse_model(file, "m")),
              ElementsAre(k_red, k_white, k_green, k_white));
  EXPECT_TRUE(parse_model(replaced(k_tetra_off, "3 0 2 1", "3 0 2 1 7"), "m").mesh.colors.empty());
}

TEST(OffReader, TakesTokensOverSeveralLines) {
  const std::string file = k_tetra_off;
  expect_tetra(parse_model(replaced(file, "3 0 1 3", "3\n0 1\n3"), "m").mesh);
  expect_tetra(parse_model(replaced(file, "0 4 0", "0\n4\n0"), "m").mesh);
  EXPECT_THAT(triangle_colors(parse_model(replaced(file, "3 0 1 3", "3 0\n1 3 255 0 0"), "m")),
              ElementsAre(k_white, k_red, k_white, k_white));
  // All on one line.
  expect_tetra(parse_model("OFF 4 4 6\n" + replaced(file.substr(10), "\n", " "), "m").mesh);
  expect_tetra(parse_model("OFF 4 4 6\n" + replaced(file.substr(10), " ", "\n"), "m").mesh);
}

TEST(OffReader, NeedsNoKeyword) {
  const std::string file = k_tetra_off;
  expect_tetra(parse_model(file.substr(4), "m").mesh);
  expect_tetra(parse_model("# made\n" + file.substr(4), "m").mesh);
  expect_tetra(parse_model("\xef\xbb\xbf" + file, "m").mesh);
  EXPECT_THAT(error_of("4 4 6 8\n0 0 0\n"), HasSubstr("wanted a mesh file"));
  EXPECT_THAT(error_of("4 4 6\nwords\n"), HasSubstr("wanted a mesh file"));
}

TEST(OffReader, CountsAStrayLastLine) {
  const std::string file = k_tetra_off;
  for (const char* stray : {"0\n", "end", "\x1a", "0 0 0\n", "0.5 0.5 0.5"}) {
    const Model model = parse_model(file + stray, "m");
    expect_tetra(model.mesh);
    EXPECT_EQ(model.report.trailing_bytes, std::string_view(stray).size());
  }
  EXPECT_THAT(error_of(file + "end\nend\n"), HasSubstr("m:11: text behind the last face"));
  EXPECT_THAT(error_of(file + "3 0 2 1\n"), HasSubstr("m:11: text behind the last face"));
}

TEST(PlyReader, AlphaAloneIsOfWhite) {
  for (const char* type : {"uchar", "float"}) {
    const std::string half = std::string_view(type) == "uchar" ? "51" : "0.2";
    const std::string whole = std::string_view(type) == "uchar" ? "255" : "1";
    const Model vertices = parse_model(
        fmt::format("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                    "property float z\nproperty {} alpha\nelement face 1\n"
                    "property list uchar int vertex_index\nend_header\n"
                    "0 0 0 {}\n1 0 0 {}\n0 1 0 {}\n3 0 1 2\n",
                    type, half, whole, half),
        "m");
    EXPECT_TRUE(vertices.report.has_colors);
    ASSERT_EQ(vertices.mesh.colors.size(), 3);
    EXPECT_EQ(vertices.mesh.colors[0], (MeshColor{1, 1, 1, 0.2F}));
    EXPECT_EQ(vertices.mesh.colors[1], k_white);
    const Model faces = parse_model(
        fmt::format("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                    "property float z\nelement face 1\n"
                    "property list uchar int vertex_index\nproperty {} alpha\nend_header\n"
                    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 {}\n",
                    type, half),
        "m");
    ASSERT_EQ(faces.mesh.colors.size(), 3);
    EXPECT_EQ(faces.mesh.colors[2], (MeshColor{1, 1, 1, 0.2F}));
  }
}

TEST(GeometryHash, HoldsColoursWhereThereAreAny) {
  const auto hash = [](const std::string& text) {
    return geometry_hash(parse_model(text, "m").mesh);
  };
  const std::string file = replaced(k_tetra_off, "OFF", "COFF");
  const auto with = [&](const char* color) {
    std::string text = file;
    for (const char* point : {"\n0 0 0", "\n4 0 0", "\n0 4 0", "\n0 0 4"})
      text = replaced(text, point, fmt::format("{} {}", point, color));
    return text;
  };
  EXPECT_NE(hash(with("1 0 0")), hash(with("0 1 0")));
  EXPECT_EQ(hash(with("1 0 0")), hash(with("255 0 0 255")));
  EXPECT_NE(hash(with("1 0 0")), hash(k_tetra_off));
}

TEST(Normalise, KeepsColours) {
  const std::string file = replaced(k_tetra_off, "3 0 2 1", "3 0 2 1 255 0 0");
  const Model model = parse_model(file, "m");
  for (const Normals normals : {Normals::smooth, Normals::flat}) {
    NormaliseOptions options;
    options.normals = normals;
    const Mesh mesh = normalise(model.mesh, options);
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    for (std::size_t t = 0; t < 4; ++t)
      for (const std::uint32_t v : mesh.triangles[t])
        EXPECT_EQ(mesh.colors[v], t == 0 ? k_red : k_white);
  }
}

}  // namespace
}  // namespace ds
