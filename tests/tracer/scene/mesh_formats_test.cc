// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_formats.h"

#include "tests/tracer/scene/mesh_samples.h"

#include <set>

namespace ds {
namespace {

TEST(MeshFormats, HaveNamesAndEndingsOfTheirOwn) {
  std::set<std::string_view> names, endings;
  for (const MeshFormat* format : mesh_formats()) {
    EXPECT_TRUE(names.insert(format->name).second) << format->name;
    EXPECT_FALSE(format->holds.empty()) << format->name;
  }
  for (const std::string_view ending : mesh_endings()) {
    EXPECT_TRUE(endings.insert(ending).second) << ending;
    EXPECT_TRUE(ending.size() > 1 && ending[0] == '.') << ending;
    EXPECT_TRUE(has_mesh_ending("folder.d/a b" + std::string(ending))) << ending;
  }
  EXPECT_GE(endings.size(), names.size());
}

TEST(MeshFormats, EndingsAreInAnyCaseAndNothingElse) {
  for (const char* name : {"a.ply", "b.PLY", "c.Off", "d.tar.off"})
    EXPECT_TRUE(has_mesh_ending(name)) << name;
  for (const char* name : {"ply", ".ply", "a.plyx", "a.pl", "a.ply.gz", "a", "a.", "off/a"})
    EXPECT_FALSE(has_mesh_ending(name)) << name;
}

TEST(MeshFormats, AreNamedInMessagesHelpAndReference) {
  EXPECT_THAT(mesh_format_names(), testing::MatchesRegex("PLY.* or [A-Za-z]+"));
  EXPECT_THAT(mesh_endings_text(" and "), testing::MatchesRegex("\\.ply.* and \\.[a-z]+"));
  for (const MeshFormat* format : mesh_formats())
    EXPECT_THAT(mesh_format_reference(),
                testing::HasSubstr(fmt::format("\n| {} | `.", format->name)));
}

/// What is of one kind must not be taken for another's, whatever the order of the list.
TEST(MeshFormats, KnowTheirOwnFilesOnly) {
  const auto matching = [](std::string_view bytes, const std::string& file) {
    std::vector<std::string_view> names;
    for (const MeshFormat* format : mesh_formats())
      if (format->matches(bytes, file)) names.push_back(format->name);
    return names;
  };
  using Names = std::vector<std::string_view>;
  EXPECT_EQ(matching(samples::k_tetra_off, "m"), Names{"OFF"});
  EXPECT_EQ(matching(samples::k_tetra_ply, "m"), Names{"PLY"});
  EXPECT_EQ(matching(samples::k_tetra_obj, "m"), Names{"OBJ"});
  EXPECT_EQ(matching("# a\nunknown 1\nv 0 0 0\n", "m.OBJ"), Names{"OBJ"});
  EXPECT_EQ(matching("unknown 1\nv 0 0 0\n", "m"), Names{});
  EXPECT_EQ(matching(samples::k_tetra_stl, "m"), Names{"STL"});
  for (const char* header : {"solid tetra", "", "made by a program"})
    EXPECT_EQ(matching(samples::tetra_binary_stl(header), "m"), Names{"STL"}) << header;
  EXPECT_EQ(matching(samples::tetra_binary_stl("cut").substr(0, 100), "m.stl"), Names{"STL"});
  EXPECT_EQ(matching(samples::tetra_binary_stl("cut").substr(0, 100), "m"), Names{});
  EXPECT_EQ(matching("", "m"), Names{});
  EXPECT_EQ(matching("GIF89a", "m.gif"), Names{});
}

/// A concave heptagonal prism: faces that a fan from any corner would get wrong, far from the origin.
struct Prism {
  std::vector<std::string> places;
  std::vector<std::vector<int>> faces;
};
Prism far_prism() {
  constexpr double k_outline[][2] = {{0, 0}, {4, 0}, {4, 3}, {3, 1}, {2, 3}, {1, 1}, {0, 3}};
  constexpr int n = 7;
  Prism prism;
  for (const double z : {0.0, 0.7})
    for (const auto& [x, y] : k_outline)
      prism.places.push_back(fmt::format("{:.3f} {:.3f} {:.3f}", 5678901.234 + x, y, z));
  std::vector<int> bottom, top;
  for (int i = 0; i < n; ++i) {
    bottom.push_back(n - 1 - i);
    top.push_back(n + i);
    prism.faces.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
  }
  prism.faces.push_back(bottom);
  prism.faces.push_back(top);
  return prism;
}

TEST(MeshFormats, OneMeshIsTheSameBitsInEachWithIndices) {
  const Prism prism = far_prism();
  std::string off = fmt::format("OFF\n{} {} 0\n", prism.places.size(), prism.faces.size());
  std::string ply = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty "
      "double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      prism.places.size(), prism.faces.size());
  std::string obj, rows;
  for (const std::string& place : prism.places) {
    rows += place + "\n";
    obj += "v " + place + "\n";
  }
  for (const std::vector<int>& face : prism.faces) {
    rows += std::to_string(face.size());
    obj += "f";
    for (const int v : face) {
      rows += fmt::format(" {}", v);
      obj += fmt::format(" {}", v + 1);
    }
    rows += "\n";
    obj += "\n";
  }
  const Model first = parse_model(off + rows, "m");
  EXPECT_EQ(first.report.triangles, 24U);
  for (const std::string& text : {ply + rows, obj}) {
    const Model model = parse_model(text, "m");
    EXPECT_EQ(mesh_hashes(model.mesh), mesh_hashes(first.mesh));
    EXPECT_EQ(geometry_hash(normalise(model.mesh, {})), geometry_hash(normalise(first.mesh, {})));
  }
}

TEST(MeshFormats, UvsNormalsAndColoursAreTheSameBitsInPlyAndObj) {
  // PLY has vertices with all of them, and OBJ corners: vertices of its own order, each with its own.
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
      "z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float u\nproperty "
      "float "
      "v\nproperty float red\nproperty float green\nproperty float blue\nelement face 2\nproperty "
      "list uchar int vertex_index\nend_header\n"
      "0 0 0 0 0 1 0 0 1 0 0.5\n1 0 0 0 0.6 0.8 1 0 0 1 0\n1 1 0 0 0 3 1 1 0 0 0\n"
      "0 1 0 0 -1 1 0.1 1 1 1 1\n3 0 1 2\n3 0 2 3\n";
  const std::string obj =
      "v 0 0 0 1 0 0.5\nv 1 0 0 0 1 0\nv 1 1 0 0 0 0\nv 0 1 0 1 1 1\n"
      "vt 0.1 1\nvt 1 1\nvt 1 0\nvt 0 0\nvn 0 0 1\nvn 0 0.6 0.8\nvn 0 -1 1\nvn 0 0 3\n"
      "f 1/4/1 2/3/2 3/2/4\nf 1/4/1 3/2/4 4/1/3\n";
  const Model a = parse_model(ply, "m"), b = parse_model(obj, "m");
  EXPECT_EQ(mesh_hashes(a.mesh), mesh_hashes(b.mesh));
  EXPECT_EQ(b.mesh.normals[3], a.mesh.normals[3]);
  EXPECT_EQ(b.mesh.uvs[3], (Vec2{0.1F, 1}));
  NormaliseOptions keep;
  keep.normals = Normals::keep;
  EXPECT_EQ(geometry_hash(normalise(a.mesh, keep)), geometry_hash(normalise(b.mesh, keep)));
}

}  // namespace
}  // namespace ds
