// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/mesh_samples.h"

#include <limits>

namespace ds {
namespace {

using samples::error_of;
using samples::expect_tetra_corners;
using samples::k_tetra_stl;
using samples::put;
using samples::replaced;
using samples::tetra_binary_stl;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::StartsWith;

TEST(StlReader, WeldsCornersOfOnePlace) {
  for (const std::string& file : {std::string(k_tetra_stl), tetra_binary_stl("a tetrahedron")}) {
    const Model model = parse_model(file, "m");
    expect_tetra_corners(model.mesh);
    EXPECT_EQ(model.report.vertices, 4U);
    EXPECT_EQ(model.report.faces, 4U);
    EXPECT_FALSE(model.report.has_normals) << "they are those of the corners";
    EXPECT_THAT(mended_damage(model.report), IsEmpty());
    EXPECT_THAT(unlikely_properties(model.report), IsEmpty());
  }
}

TEST(StlReader, NegativeZeroIsThePlaceOfZero) {
  expect_tetra_corners(
      parse_model(replaced(k_tetra_stl, "vertex 0 4 0", "vertex -0 4 -0.0"), "m").mesh);
}

TEST(StlReader, TakesTextInAnyCaseWithAnyLineEnds) {
  for (const char* eol : {"\r\n", "\r", "\n\n", " \t\n"})
    expect_tetra_corners(parse_model(replaced(k_tetra_stl, "\n", eol), "m").mesh);
  std::string capitals = k_tetra_stl;
  for (char& c : capitals)
    c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  expect_tetra_corners(parse_model(capitals, "m").mesh);
  for (const char* solid :
       {"solid", "solid a name of facet words ", "\xef\xbb\xbfsolid x", "\n  solid x"})
    expect_tetra_corners(
        parse_model(solid + std::string(k_tetra_stl).substr(sizeof("solid tetra") - 1), "m").mesh);
  for (const char* normal : {"", "normal -nan(ind) 1.#QNAN nan", "normal 9 9 9"})
    expect_tetra_corners(parse_model(replaced(k_tetra_stl, "normal 0 0 0", normal), "m").mesh);
}

TEST(StlReader, ReadsSeveralSolidsAndLoopsOfMoreCorners) {
  std::string two = k_tetra_stl;
  two += replaced(k_tetra_stl, "vertex ", "vertex 1");  // 10 away: "0 0 0" becomes "10 0 0"
  EXPECT_EQ(parse_model(two, "m").mesh.triangles.size(), 8U);
  const Model square = parse_model(
      "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n"
      "vertex 0 1 0\nendloop\nendfacet\nendsolid\n",
      "m");
  EXPECT_EQ(square.report.n_gons, 1U);
  EXPECT_EQ(square.mesh.triangles.size(), 2U);
}

TEST(StlReader, ABinaryFileMayBeginWithSolid) {
  for (const char* header : {"solid tetra", "solid\n facet normal 0 0 0\n outer loop", "", "ply",
                             "v 1 2 3\n", "COLOR=abcd"})
    expect_tetra_corners(parse_model(tetra_binary_stl(header), "m").mesh);
}

TEST(StlReader, TheCountInTheHeaderMustHold) {
  const std::string file = tetra_binary_stl("solid of 4");
  const auto with_count = [&](std::uint32_t count) {
    std::string changed = file.substr(0, 80);
    put<std::uint32_t>(changed, count, std::endian::little);
    return changed + file.substr(84);
  };
  const auto read = [](const std::string& bytes) { return parse_model(bytes, "m.stl"); };
  const Model fewer = read(with_count(3));
  EXPECT_EQ(fewer.mesh.triangles.size(), 3U);
  EXPECT_THAT(mended_damage(fewer.report), ElementsAre(Pair("trailing_bytes", 50)));
  EXPECT_THAT(mended_damage(read(file + "abc").report), ElementsAre(Pair("trailing_bytes", 3)));
  for (const std::string& bytes : {with_count(5), with_count(0x00ffffff), with_count(0xff000000)})
    try {
      read(bytes);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("cut off: the header promises"));
      EXPECT_THAT(error.what(), HasSubstr("facets, found 4"));
    }
  EXPECT_THROW(read(with_count(0)), Error);
}

TEST(StlReader, EveryCutIsAnError) {
  const std::string text = k_tetra_stl, binary = tetra_binary_stl("x");
  for (std::size_t size = 0; size + sizeof("endsolid tetra") - 1 < text.size(); ++size)
    EXPECT_THROW(parse_model(text.substr(0, size), "m.stl"), Error) << size;
  for (std::size_t size = 0; size < binary.size(); ++size)
    EXPECT_THROW(parse_model(binary.substr(0, size), "m.stl"), Error) << size;
}

TEST(StlReader, CountsAttributesThatMayBeColours) {
  std::string file = tetra_binary_stl("x");
  file[84 + 48] = 1;
  file[84 + 50 + 49] = '\x80';
  EXPECT_THAT(unlikely_properties(parse_model(file, "m").report),
              ElementsAre(Pair("unused_attributes", 2)));
}

TEST(StlReader, DamagedNumbersAreMendedAsInOtherFormats) {
  std::string file = tetra_binary_stl("x").substr(0, 80);
  put<std::uint32_t>(file, 5, std::endian::little);
  file += tetra_binary_stl("x").substr(84);
  std::string facet;
  for (int i = 0; i < 12; ++i)
    put<float>(facet, i == 4 ? std::numeric_limits<double>::quiet_NaN() : i, std::endian::little);
  const Model model = parse_model(file + facet + std::string(2, '\0'), "m");
  expect_tetra_corners(model.mesh);
  EXPECT_THAT(mended_damage(model.report), ElementsAre(Pair("non_finite", 1)));
}

TEST(StlReader, NamesTheLineOfWhatIsBroken) {
  const auto broken = [&](const char* from, const char* to) {
    return error_of(replaced(k_tetra_stl, from, to));
  };
  EXPECT_THAT(broken("outer loop", "loop"), StartsWith("m:3: wanted outer, found \"loop\""));
  EXPECT_THAT(broken("vertex 4 0 0", "vertex 4 0"),
              HasSubstr("wanted a number, found \"endloop\""));
  EXPECT_THAT(broken("vertex 4 0 0", "vertex 4 0 0 0"),
              HasSubstr("wanted vertex or endloop, found \"0\""));
  EXPECT_THAT(broken("endfacet", "end"), HasSubstr("wanted endfacet, found \"end\""));
  EXPECT_THAT(broken("endsolid tetra", "endsolid tetra\nrest"),
              HasSubstr("wanted solid, found \"rest\""));
}

}  // namespace
}  // namespace ds
