// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/mesh_samples.h"

#include <filesystem>
#include <fstream>

namespace ds {
namespace {

using samples::error_of;
using samples::k_tetra_positions;
using samples::k_tetra_triangles;
using samples::put;
using samples::replaced;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

constexpr int k_byte = 5120, k_ubyte = 5121, k_short = 5122, k_ushort = 5123, k_uint = 5125,
              k_float = 5126;

std::string base64(std::string_view bytes) {
  constexpr std::string_view k_digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : k_digits[three >> (18 - 6 * k) & 63U];
  }
  return text;
}

void put_component(std::string& out, int type, double value) {
  constexpr auto order = std::endian::little;
  switch (type) {
    case k_byte:
      return put<std::int8_t>(out, value, order);
    case k_ubyte:
      return put<std::uint8_t>(out, value, order);
    case k_short:
      return put<std::int16_t>(out, value, order);
    case k_ushort:
      return put<std::uint16_t>(out, value, order);
    case k_uint:
      return put<std::uint32_t>(out, value, order);
    default:
      return put<float>(out, value, order);
  }
}

/// A file as its bytes and text are put together here.
struct Written {
  std::string bin, views, accessors, primitives, nodes = R"({"mesh":0})", scene_nodes = "0", more;

  int view(const std::string& bytes) {
    while (bin.size() % 4 != 0)
      bin += '\0';
    views += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}}})",
                         views.empty() ? "" : ",", bin.size(), bytes.size());
    bin += bytes;
    return view_count++;
  }
  int accessor(const std::string& type, int component, const std::vector<double>& numbers,
               const std::string& options = "") {
    std::string bytes;
    for (const double number : numbers)
      put_component(bytes, component, number);
    const std::size_t width = type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : 4;
    return add_accessor(
        fmt::format(R"("bufferView":{},"componentType":{},"type":"{}","count":{}{})", view(bytes),
                    component, type, numbers.size() / width, options));
  }
  int add_accessor(const std::string& text) {
    accessors += fmt::format("{}{{{}}}", accessors.empty() ? "" : ",", text);
    return accessor_count++;
  }
  void primitive(const std::string& attributes, const std::string& options = "") {
    primitives += fmt::format(R"({}{{"attributes":{{{}}}{}}})", primitives.empty() ? "" : ",",
                              attributes, options);
  }
  std::string json(const std::string& buffer) const {
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],"meshes":[{{"primitives":[{}]}}],)"
        R"("accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}{}}}]{}}})",
        scene_nodes, nodes, primitives, accessors, views, bin.size(), buffer, more);
  }
  std::string text() const {
    return json(R"(,"uri":"data:application/octet-stream;base64,)" + base64(bin) + '"');
  }
  std::string glb() const {
    std::string chunk = json("");
    chunk.resize((chunk.size() + 3) / 4 * 4, ' ');
    std::string data = bin;
    data.resize((data.size() + 3) / 4 * 4, '\0');
    std::string out = "glTF";
    const auto word = [&](double value) { put<std::uint32_t>(out, value, std::endian::little); };
    word(2);
    word(static_cast<double>(12 + 8 + chunk.size() + 8 + data.size()));
    word(static_cast<double>(chunk.size()));
    out += "JSON" + chunk;
    word(static_cast<double>(data.size()));
    out += std::string("BIN\0", 4) + data;
    return out;
  }

  int view_count = 0, accessor_count = 0;
};

std::vector<double> flat(const std::vector<Vec3d>& places) {
  std::vector<double> numbers;
  for (const Vec3d& p : places)
    numbers.insert(numbers.end(), {p.x, p.y, p.z});
  return numbers;
}
std::vector<double> flat(const samples::Triangles& triangles) {
  std::vector<double> numbers;
  for (const auto& t : triangles)
    numbers.insert(numbers.end(), t.begin(), t.end());
  return numbers;
}

Written tetra(int index_type = k_ushort) {
  Written w;
  const int places = w.accessor("VEC3", k_float, flat(k_tetra_positions));
  const int indices = w.accessor("SCALAR", index_type, flat(k_tetra_triangles));
  w.primitive(fmt::format(R"("POSITION":{})", places), fmt::format(R"(,"indices":{})", indices));
  return w;
}

/// Corner by corner, as the vertices stand in the order of their use.
void expect_corners(const FileMesh& mesh, const std::vector<Vec3d>& expected) {
  ASSERT_EQ(mesh.triangles.size() * 3, expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(mesh.positions[mesh.triangles[i / 3][i % 3]], expected[i]) << i;
}

TEST(GltfReader, IsTheSameMeshAsInOtherFormats) {
  for (const int type : {k_ubyte, k_ushort, k_uint})
    for (const std::string& file : {tetra(type).text(), tetra(type).glb()}) {
      const Model model = parse_model(file, "m");
      samples::expect_tetra_corners(model.mesh);
      EXPECT_EQ(model.report.vertices, 4U);
      EXPECT_EQ(model.report.faces, 4U);
      EXPECT_THAT(mended_damage(model.report), IsEmpty());
      EXPECT_THAT(unlikely_properties(model.report), IsEmpty());
    }
}

TEST(GltfReader, TakesStripsFansAndVerticesWithoutIndices) {
  const std::vector<Vec3d> places{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5}, {0, 2, 0}};
  const auto mode = [&](int number) {
    Written w;
    w.primitive(fmt::format(R"("POSITION":{})", w.accessor("VEC3", k_float, flat(places))),
                fmt::format(R"(,"mode":{})", number));
    return parse_model(w.text(), "m", Winding::as_stored).mesh;
  };
  // Each triangle of a strip is wound as its first.
  expect_corners(mode(5), {places[0], places[1], places[2], places[1], places[3], places[2],
                           places[2], places[3], places[4]});
  expect_corners(mode(6), {places[1], places[2], places[0], places[2], places[3], places[0],
                           places[3], places[4], places[0]});
  Written w;
  w.primitive(fmt::format(R"("POSITION":{})", w.accessor("VEC3", k_float, flat(places))));
  const Model left_over = parse_model(w.text(), "m");
  EXPECT_EQ(left_over.mesh.triangles.size(), 1U);
  EXPECT_THAT(mended_damage(left_over.report), ElementsAre(Pair("short_faces", 1)));
}

// The right values: a turn about z by 90 degrees takes (x, y, z) to (-y, x, z).
TEST(GltfReader, AppliesTheTransformsOfNodes) {
  const std::vector<Vec3d> places{{0, 0, 0}, {2, 0, 0}, {0, 3, 1}};
  Written w;
  const int normals = w.accessor("VEC3", k_float, {1, 0, 0, 1, 0, 0, 1, 0, 0});
  w.primitive(fmt::format(R"("POSITION":{},"NORMAL":{})", w.accessor("VEC3", k_float, flat(places)),
                          normals));
  w.scene_nodes = "1";
  w.nodes = R"({"mesh":0,"scale":[2,1,1]},{"translation":[10,0,0],"children":[2]},)"
            R"({"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,0,0,0,1],"children":[0]})";
  const FileMesh mesh = parse_model(w.text(), "m", Winding::as_stored).mesh;
  expect_corners(mesh, {{10, 0, 0}, {10, 4, 0}, {7, 0, 1}});
  for (const Vec3 n : mesh.normals)
    EXPECT_EQ(n, (Vec3{0, 1, 0}));
  // A mirror turns faces over, and its normals stay on their side.
  w.nodes = R"({"mesh":0,"scale":[-1,1,1]},{"children":[0]})";
  const FileMesh mirrored = parse_model(w.text(), "m", Winding::as_stored).mesh;
  expect_corners(mirrored, {{0, 0, 0}, {0, 3, 1}, {-2, 0, 0}});
  for (const Vec3 n : mirrored.normals)
    EXPECT_EQ(n, (Vec3{-1, 0, 0}));
  // A quaternion, about y by 90 degrees: (x, y, z) to (z, y, -x).
  w.nodes = R"({"mesh":0,"rotation":[0,0.7071067811865476,0,0.7071067811865476]},{"children":[0]})";
  const FileMesh turned = parse_model(w.text(), "m", Winding::as_stored).mesh;
  EXPECT_NEAR(turned.positions[1].z, -2, 1e-12);
  EXPECT_NEAR(turned.positions[2].x, 1, 1e-12);
  EXPECT_NEAR(turned.positions[2].y, 3, 1e-12);
}

TEST(GltfReader, ReadsAttributesOfAnyTypeAndKeepsWhatPrimitivesUse) {
  Written w;
  const int places = w.accessor("VEC3", k_float, {9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int uvs =
      w.accessor("VEC2", k_ushort, {0, 0, 0, 65535, 65535, 0, 0, 0}, R"(,"normalized":true)");
  const int colors =
      w.accessor("VEC4", k_ubyte, {0, 0, 0, 0, 255, 0, 51, 255, 0, 0, 0, 0, 0, 0, 0, 0},
                 R"(,"normalized":true)");
  const int normals = w.accessor("VEC3", k_byte, {0, 0, 0, 0, 0, 127, 0, 0, -128, 0, 127, 0},
                                 R"(,"normalized":true)");
  const int indices = w.accessor("SCALAR", k_ubyte, {1, 2, 3});
  w.primitive(fmt::format(R"("POSITION":{},"TEXCOORD_0":{},"COLOR_0":{},"NORMAL":{})", places, uvs,
                          colors, normals),
              fmt::format(R"(,"indices":{})", indices));
  const Model model = parse_model(w.text(), "m", Winding::as_stored);
  expect_corners(model.mesh, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  ASSERT_EQ(model.mesh.positions.size(), 3U) << "the unused one is not there";
  EXPECT_EQ(model.mesh.uvs[0], (Vec2{0, 1}));
  EXPECT_EQ(model.mesh.uvs[1], (Vec2{1, 0}));
  EXPECT_THAT(model.mesh.colors[0], ElementsAre(1, 0, 0.2f, 1));
  EXPECT_EQ(model.mesh.normals[0], (Vec3{0, 0, 1}));
  EXPECT_EQ(model.mesh.normals[1], (Vec3{0, 0, -1}));
}

TEST(GltfReader, ReadsSparseAccessors) {
  Written w;
  std::string indices, values;
  for (const int i : {1, 2})
    put<std::uint16_t>(indices, i, std::endian::little);
  for (const double v : {5.0, 0.0, 0.0, 0.0, 7.0, 0.0})
    put<float>(values, v, std::endian::little);
  const std::string sparse = fmt::format(
      R"(,"sparse":{{"count":2,"indices":{{"bufferView":{},"componentType":5123}},"values":{{"bufferView":{}}}}})",
      w.view(indices), w.view(values));
  const int over = w.accessor("VEC3", k_float, {0, 0, 0, 1, 1, 1, 2, 2, 2}, sparse);
  w.primitive(fmt::format(R"("POSITION":{})", over));
  expect_corners(parse_model(w.text(), "m", Winding::as_stored).mesh,
                 {{0, 0, 0}, {5, 0, 0}, {0, 7, 0}});
  const int nothing = w.add_accessor(R"("componentType":5126,"type":"VEC3","count":3)" + sparse);
  w.primitives.clear();
  w.primitive(fmt::format(R"("POSITION":{})", nothing));
  expect_corners(parse_model(w.text(), "m", Winding::as_stored).mesh,
                 {{0, 0, 0}, {5, 0, 0}, {0, 7, 0}});
}

TEST(GltfReader, SaysWhatItLeavesOut) {
  Written w = tetra();
  w.primitive(R"("POSITION":0)", R"(,"mode":1)");
  w.primitive(R"("POSITION":0)", R"(,"material":1,"targets":[{"POSITION":0}])");
  w.nodes = R"({"mesh":0,"skin":0,"translation":[5,5,5]})";
  w.more = R"(,"materials":[{},{}],"skins":[{"joints":[0]}])";
  const Model model = parse_model(w.text(), "m");
  EXPECT_THAT(unlikely_properties(model.report),
              ElementsAre(Pair("unused_materials", 1), Pair("unused_elements", 1),
                          Pair("unused_poses", 1)));
  EXPECT_EQ(model.mesh.positions[0], (Vec3d{0, 0, 0}));
}

TEST(GltfReader, RefusesWhatIsBroken) {
  const std::string good = tetra().text();
  const auto changed = [&](const char* from, const char* to) {
    const std::string bad = replaced(good, from, to);
    EXPECT_NE(bad, good) << from;
    return error_of(bad);
  };
  EXPECT_THAT(changed(R"("count":4)", R"("count":5)"),
              HasSubstr("accessor 0 has 5 elements of 12 bytes"));
  EXPECT_THAT(changed(R"("count":4)", R"("count":4000000000000000000)"),
              HasSubstr("accessor 0 has 4"));
  EXPECT_THAT(changed(R"("byteLength":48)", R"("byteLength":4800)"),
              HasSubstr("buffer view 0 ends at byte 4800"));
  EXPECT_THAT(changed(R"("POSITION":0)", R"("POSITION":7)"),
              HasSubstr("wanted an accessor below 2, found 7"));
  EXPECT_THAT(changed(R"("mesh":0)", R"("mesh":3)"), HasSubstr("wanted a mesh below 1, found 3"));
  EXPECT_THAT(changed(R"("mesh":0)", R"("mesh":0,"children":[0])"),
              HasSubstr("node 0 is below itself"));
  EXPECT_THAT(changed(R"("version":"2.0")", R"("version":"1.0")"),
              HasSubstr("wanted glTF of version 2, found version 1.0"));
  EXPECT_THAT(
      changed(R"("scene":0)", R"("extensionsRequired":["KHR_draco_mesh_compression"],"scene":0)"),
      HasSubstr("requires the glTF extension KHR_draco_mesh_compression, which is not read"));
  EXPECT_THAT(changed(R"("nodes":[0])", R"("nodes":[])"), HasSubstr("its scene has no faces"));
  EXPECT_THAT(error_of(std::string(100000, '[').insert(0, R"({"extras":)")),
              HasSubstr("nested deeper than 64"));
  EXPECT_THAT(
      error_of(good.substr(0, good.size() / 2)),
      HasSubstr(fmt::format("m: its JSON cannot be read: parse error at line 1, column {}: ",
                            good.size() / 2 + 1)));
  const std::string binary = tetra().glb();
  for (std::size_t size = 4; size < binary.size(); size += 7)
    EXPECT_THAT(error_of(binary.substr(0, size)), HasSubstr("m: "));
}

TEST(GltfReader, OpensNoFileBesideItsFolder) {
  for (const char* uri : {"../../etc/passwd", "/etc/passwd", "a/../../b.bin", "%2e%2e/b.bin",
                          "http://a/b.bin", "file:///etc/passwd", "c:\\b.bin", "a%00b", ""})
    EXPECT_THAT(error_of(tetra().json(fmt::format(R"(,"uri":"{}")", replaced(uri, "\\", "\\\\")))),
                HasSubstr("wanted a file beside it or below, found the uri"))
        << uri;
}

// Of a kilobyte, whatever it says.
TEST(GltfReader, MakesNoMoreThanItsSizeAllows) {
  Written w;
  w.primitive(
      fmt::format(R"("POSITION":{})",
                  w.add_accessor(R"("componentType":5126,"type":"VEC3","count":1000000000)")));
  w.view("abcd");
  EXPECT_THAT(error_of(w.text()), HasSubstr("1000000000 elements is in no buffer view"));
  Written many = tetra();
  many.primitives.clear();
  many.primitive(
      fmt::format(R"("POSITION":{})",
                  many.add_accessor(R"("componentType":5126,"type":"VEC3","count":100000)")));
  many.nodes.clear();
  many.scene_nodes.clear();
  for (int i = 0; i < 20; ++i) {
    many.nodes += fmt::format(R"({}{{"mesh":0}})", i == 0 ? "" : ",");
    many.scene_nodes += fmt::format("{}{}", i == 0 ? "" : ",", i);
  }
  EXPECT_THAT(error_of(many.text()), HasSubstr("too many for a file of its size"));
}

TEST(GltfReader, ReadsBuffersBesideIt) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "gltf_reader_test";
  std::filesystem::create_directories(folder / "a b");
  const Written w = tetra();
  std::ofstream(folder / "m.gltf") << w.json(R"(,"uri":"a%20b/c.bin")");
  std::ofstream(folder / "a b/c.bin") << w.bin << "padding";
  samples::expect_tetra_corners(read_model(folder / "m.gltf").mesh);
  EXPECT_THAT(model_parts(folder / "m.gltf"), ElementsAre(folder / "a b/c.bin"));
  EXPECT_TRUE(may_have_parts("x.GLTF"));
  EXPECT_FALSE(may_have_parts("x.obj"));
  std::ofstream(folder / "a b/c.bin") << w.bin.substr(1);
  EXPECT_THROW(read_model(folder / "m.gltf"), Error);
  std::filesystem::remove_all(folder);
  EXPECT_THROW(read_model(folder / "m.gltf"), Error);
}

}  // namespace
}  // namespace ds
