// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mtl_reader.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <gmock/gmock.h>

#include <cmath>

namespace ds {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::UnorderedElementsAre;
using Notes = std::map<std::string, std::uint64_t>;

MtlDefinitions parsed(std::string_view text) {
  MtlDefinitions defined;
  parse_mtl(text, "/models/a/a.mtl", defined);
  return defined;
}
MtlMaterial only(std::string_view lines) {
  const MtlDefinitions defined = parsed("newmtl m\n" + std::string(lines));
  EXPECT_EQ(defined.materials.size(), 1U);
  return defined.materials.at("m");
}
float number(const MtlMaterial& material, const char* input) {
  return material.material.inputs.at(input).factor.x;
}
std::string error_of(std::string_view text) {
  try {
    parsed(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::asset);
    return error.what();
  }
  return "";
}

TEST(Mtl, ColoursAreLinearAndOneNumberIsGrey) {
  EXPECT_EQ(only("Kd 0.25 0.5 1\n").material.inputs.at("basecolor").factor, (Vec3{0.25F, 0.5F, 1}));
  EXPECT_EQ(only("Kd 0.25\n").material.inputs.at("basecolor").factor, (Vec3{0.25F, 0.25F, 0.25F}));
  EXPECT_EQ(only("").material.inputs.at("basecolor").factor, (Vec3{1, 1, 1}));
}

TEST(Mtl, RoughnessIsThatOfGgxForBlinnAndPhongsExponent) {
  // alpha^2 = 2 / (Ns + 2) by Walter et al.; disney's alpha is roughness^2.
  for (const double ns : {0.0, 1.0, 10.0, 96.0, 998.0, 1e6}) {
    const double r = double{number(only(fmt::format("Ks 1\nNs {}\n", ns)), "roughness")};
    EXPECT_NEAR(std::pow(r, 4) * (ns + 2), 2, 1e-5) << ns;
  }
  EXPECT_FLOAT_EQ(number(only("Ns 10\nPr 0.75\n"), "roughness"), 0.75F);  // says it itself
  EXPECT_FLOAT_EQ(number(only(""), "roughness"), 0.5F);
  EXPECT_FLOAT_EQ(number(only("Ns -3\n"), "roughness"), 1);
}

TEST(Mtl, HighlightsAreThoseThatTheFileAsksFor) {
  EXPECT_FLOAT_EQ(number(only("Kd 1\n"), "specular"), 0);
  EXPECT_FLOAT_EQ(number(only("Ks 0.25 0.5 0.75\n"), "specular"), 0.5F);
  EXPECT_FLOAT_EQ(number(only("Ks 0.5\nillum 1\n"), "specular"), 0);
  EXPECT_FLOAT_EQ(number(only("Pr 0.1\n"), "specular"), 0.5F);
  EXPECT_FLOAT_EQ(number(only("map_Pm m.png\nillum 1\n"), "specular"), 0.5F);
  EXPECT_FLOAT_EQ(number(only("Pr 0.1\nKs 0\n"), "specular"), 0);
  EXPECT_FLOAT_EQ(number(only("Pm 0.25\n"), "metallic"), 0.25F);
}

TEST(Mtl, NumbersOutOfRangeAreHeldAndCounted) {
  const MtlMaterial m = only("Kd 255 -1 0.5\nPr nan\n");
  EXPECT_EQ(m.material.inputs.at("basecolor").factor, (Vec3{1, 0, 0.5F}));
  EXPECT_EQ(number(m, "roughness"), 0);
  EXPECT_EQ(m.notes, (Notes{{"out_of_range", 3}}));
}

TEST(Mtl, MapsTakeTheRestOfTheLineForTheirFile) {
  const MtlMaterial m = only(
      "map_Kd -s 2 3 1 -o 0.25 0.5 -clamp on tex tures\\my red.png  \nmap_Pr ../r.png\n"
      "MAP_PM -imfchan b m.png\n");
  EXPECT_THAT(m.images, UnorderedElementsAre(Pair("basecolor", "/models/a/tex tures/my red.png"),
                                             Pair("roughness", "/models/r.png"),
                                             Pair("metallic", "/models/a/m.png")));
  // u' = 2 u + 0.25; the place up is 3 v + 0.5, so that down from the top is 1 less that.
  EXPECT_THAT(m.material.inputs.at("basecolor").uv_transform,
              ElementsAre(2, 0, 0.25F, 0, -3, 0.5F));
  EXPECT_EQ(m.material.inputs.at("basecolor").wrap, ImageWrap::clamp);
  EXPECT_TRUE(m.material.inputs.at("basecolor").srgb);
  EXPECT_FALSE(m.material.inputs.at("roughness").srgb);
  EXPECT_THAT(m.material.inputs.at("roughness").uv_transform, ElementsAre(1, 0, 0, 0, -1, 1));
  EXPECT_EQ(m.material.inputs.at("metallic").channel, ImageChannel::blue);
  EXPECT_THAT(m.notes, IsEmpty());
}

TEST(Mtl, AMapMultipliesKdAndStandsForPrAndPm) {
  EXPECT_EQ(only("Kd 0.5\nmap_Kd a.png\n").material.inputs.at("basecolor").factor,
            (Vec3{0.5F, 0.5F, 0.5F}));
  EXPECT_EQ(only("Pr 0.5\nmap_Pr a.png\n").material.inputs.at("roughness").factor, (Vec3{1, 1, 1}));
  const MtlMaterial black = only("Kd 0 0 0\nmap_Kd a.png\n");
  EXPECT_EQ(black.material.inputs.at("basecolor").factor, (Vec3{1, 1, 1}));
  EXPECT_EQ(black.notes, (Notes{{"black_factor", 1}}));
}

TEST(Mtl, AFileWhoseNameIsANumberIsOne) {
  EXPECT_THAT(only("map_Kd -s 1 1 1 1\n").images, ElementsAre(Pair("basecolor", "/models/a/1")));
  EXPECT_THAT(only("map_Kd -o 0.5 7.png\n").images,
              ElementsAre(Pair("basecolor", "/models/a/7.png")));
}

TEST(Mtl, AnAbsolutePathOfAnotherMachineIsLookedForBesideTheFile) {
  EXPECT_THAT(only("map_Kd C:\\Users\\me\\wood.png\n").images,
              ElementsAre(Pair("basecolor", "/models/a/wood.png")));
  EXPECT_THAT(only("map_Kd /nonexistent/of/me/wood.png\n").images,
              ElementsAre(Pair("basecolor", "/models/a/wood.png")));
}

TEST(Mtl, WhatIsNotUsedIsCountedByItsKind) {
  EXPECT_EQ(only("Ka 1\nNi 1.45\nTf 1 1 1\nd 1\nillum 2\nKe 0 0 0\n").notes, Notes{});
  EXPECT_EQ(only("d 0.5\n").notes, (Notes{{"transparency", 1}}));
  EXPECT_EQ(only("d -halo 0.5\n").notes, (Notes{{"transparency", 1}}));
  EXPECT_EQ(only("Tr 0.25\n").notes, (Notes{{"transparency", 1}}));
  EXPECT_EQ(only("d 1\nTr 1\n").notes, Notes{});  // programs write it the wrong way round
  EXPECT_EQ(only("illum 7\n").notes, (Notes{{"transparency", 1}}));
  EXPECT_EQ(only("map_d a.png\n").notes, (Notes{{"transparency", 1}}));
  EXPECT_EQ(only("Ke 0 0 2\n").notes, (Notes{{"emission", 1}}));
  EXPECT_EQ(only("map_Ke a.png\n").notes, (Notes{{"emission", 1}}));
  EXPECT_EQ(only("bump a.png\nnorm b.png\n").notes, (Notes{{"normal_maps", 2}}));
  EXPECT_EQ(only("map_Ks a.png\n").notes, (Notes{{"highlight_maps", 1}}));
  EXPECT_EQ(only("Pc 0.5\nmap_Ps a.png\n").notes, (Notes{{"extensions", 2}}));
  EXPECT_EQ(only("map_Kd -blendu on -mm 0 1 a.png\n").notes, (Notes{{"map_options", 2}}));
  EXPECT_EQ(only("hello world\n").notes, (Notes{{"unknown_lines", 1}}));
  EXPECT_EQ(parsed("Kd 1\nnewmtl a\n").notes, (Notes{{"unknown_lines", 1}}));
}

TEST(Mtl, AnyLineEndAndAByteOrderMarkAreRead) {
  const MtlDefinitions defined =
      parsed("\xef\xbb\xbfnewmtl red wood \r\nKd 0.5 0 0 # dark\r\n\r\n\tKs 1\rnewmtl b\nKd 0.25");
  ASSERT_EQ(defined.materials.size(), 2U);
  EXPECT_FLOAT_EQ(number(defined.materials.at("red wood"), "basecolor"), 0.5F);
  EXPECT_FLOAT_EQ(number(defined.materials.at("red wood"), "specular"), 1);
  EXPECT_FLOAT_EQ(number(defined.materials.at("b"), "basecolor"), 0.25F);
  EXPECT_THAT(error_of("\xff\xfen\0e\0"), HasSubstr("UTF-16"));
}

TEST(Mtl, OfTwoOfOneNameTheLaterCounts) {
  EXPECT_FLOAT_EQ(
      number(parsed("newmtl m\nKd 1\nmap_Kd a.png\nnewmtl m\nKd 0.25\n").materials.at("m"),
             "basecolor"),
      0.25F);
}

TEST(Mtl, WhatIsNoNumberIsAnErrorAtItsLine) {
  EXPECT_EQ(error_of("newmtl m\n\nKd red\n"), "/models/a/a.mtl:3: wanted a number, found \"red\"");
  EXPECT_EQ(error_of("newmtl m\nmap_Kd\n"),
            "/models/a/a.mtl:2: wanted a file behind map_kd, found none");
}

TEST(Mtl, AnObjFileNamesItsFilesAndTheyMayHaveBlanks) {
  const auto files = [](const std::vector<std::string>& lines) {
    std::vector<std::string> names;
    for (const auto& file : mtl_files(lines, "/models/a/a.obj"))
      names.push_back(file.string());
    return names;
  };
  EXPECT_THAT(files({"a.mtl b.MTL"}), ElementsAre("/models/a/a.mtl", "/models/a/b.MTL"));
  EXPECT_THAT(files({"my red  a.mtl", "..\\lib\\b.mtl", "my red  a.mtl"}),
              ElementsAre("/models/a/my red  a.mtl", "/models/lib/b.mtl"));
  EXPECT_THAT(files({"a.mtl left over"}), ElementsAre("/models/a/a.mtl", "/models/a/left over"));
  EXPECT_THAT(files({"./materials"}), ElementsAre("/models/a/materials"));
  EXPECT_THAT(files({}), IsEmpty());
}

TEST(Mtl, MaterialsComeInTheOrderTheyAreAskedForFromAllFiles) {
  const TemporaryFolder folder;
  const auto one = folder.path() / "one.mtl", two = folder.path() / "two.mtl";
  write_file_atomic(one, "newmtl a\nKd 0.25\nmap_Kd a.png\nnewmtl unused\nmap_Kd u.png\nd 0\n");
  write_file_atomic(two, "newmtl b\nKd 0.5\nmap_Kd a.png\n");
  const OwnMaterials own = mtl_materials({one, two}, {"b", "none", "a"});
  ASSERT_EQ(own.materials.size(), 3U);
  EXPECT_EQ(own.materials[0].inputs.at("basecolor").factor.x, 0.5F);
  EXPECT_EQ(own.materials[0].inputs.at("basecolor").image, 0);
  EXPECT_EQ(own.materials[1].name, "none");
  EXPECT_EQ(own.materials[1].inputs, light_grey().inputs);
  EXPECT_EQ(own.materials[2].inputs.at("basecolor").image, 0);
  EXPECT_THAT(own.images, ElementsAre(OwnImage{folder.path() / "a.png", -1, {}}));
  EXPECT_EQ(own.notes, (Notes{{"undefined", 1}}));  // what nothing shows is not counted
  try {
    mtl_materials({one, folder.path() / "three.mtl"}, {"a"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("three.mtl: wanted the file that a model's own materials"));
  }
}

}  // namespace
}  // namespace ds
