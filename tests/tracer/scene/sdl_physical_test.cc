// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/sdl_files_for_tests.h"
#include "tracer/scene/texture_bounds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace ds {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> found(std::string_view text) {
  const ds::testing::SdlFolder folder;
  std::vector<std::string> lines;
  for (const Material& material : folder.material(text).materials)
    lines.insert(lines.end(), material.unphysical.begin(), material.unphysical.end());
  return lines;
}

TEST(SdlPhysical, SharesOfLightAreAtMostAll) {
  EXPECT_THAT(found("scene.materials.a.kd = 1 1 1\n"), IsEmpty());
  EXPECT_THAT(found("scene.materials.a.type = matte\nscene.materials.a.kd = 255 0 0\n"),
              ElementsAre(EndsWith("m.scn:2: scene.materials.a.kd: wanted numbers in [0, 1], found "
                                   "255 0 0: it gives back more light than it gets")));
  for (const char* input : {"glossy2\nscene.materials.a.kd", "glossy2\nscene.materials.a.ks",
                            "mirror\nscene.materials.a.kr", "glass\nscene.materials.a.kr",
                            "glass\nscene.materials.a.kt"}) {
    const std::string text = std::string("scene.materials.a.type = ") + input;
    EXPECT_EQ(found(text + " = 1.01\n").size(), 1) << input;
    EXPECT_THAT(found(text + " = 1\n"), IsEmpty()) << input;
  }
}

TEST(SdlPhysical, WhatIsNoShareMayBeLarge) {
  EXPECT_THAT(
      found(
          "scene.materials.a.type = glossy2\nscene.materials.a.ka = 9 9 9\n"
          "scene.materials.a.d = 7\nscene.materials.a.index = 2.4\n"
          "scene.materials.a.emission = 500 500 500\nscene.materials.a.emission.gain = 80 80 80\n"),
      IsEmpty());
  EXPECT_THAT(found("scene.materials.a.type = metal2\nscene.materials.a.n = 3\n"
                    "scene.materials.a.k = 7\n"),
              IsEmpty());
}

TEST(SdlPhysical, TexturesAreFollowedAsFarAsTheirConstantsTell) {
  const auto with = [](const std::string& textures) {
    return found(textures + "scene.materials.a.kd = t\n");
  };
  const std::string checks =
      "scene.textures.c.type = checkerboard3d\nscene.textures.c.mapping.type = globalmapping3d\n";
  EXPECT_THAT(with("scene.textures.t.type = constfloat3\nscene.textures.t.value = 2 0 0\n"),
              ElementsAre(EndsWith("found 2 0 0: it gives back more light than it gets")));
  EXPECT_THAT(with(checks + "scene.textures.c.texture1 = 0.2 3 0.2\nscene.textures.t.type = scale\n"
                            "scene.textures.t.texture1 = c\nscene.textures.t.texture2 = 0.5\n"),
              ElementsAre(EndsWith(
                  "wanted numbers in [0, 1], found a texture that goes up to 0.1 1.5 0.1: it "
                  "gives back more light than it gets")));
  EXPECT_THAT(
      with(checks + "scene.textures.t.type = subtract\nscene.textures.t.texture1 = 0.5\n"
                    "scene.textures.t.texture2 = c\n"),
      ElementsAre(EndsWith("wanted numbers in [0, 1], found a texture that goes down to -0.5")));
  EXPECT_THAT(with("scene.textures.t.type = mix\nscene.textures.t.amount = 0.25\n"
                   "scene.textures.t.texture1 = 0\nscene.textures.t.texture2 = 4\n"),
              IsEmpty());
  EXPECT_EQ(with("scene.textures.t.type = mix\nscene.textures.t.amount = 0.5\n"
                 "scene.textures.t.texture1 = 0\nscene.textures.t.texture2 = 4\n")
                .size(),
            1);
  // 0 to 1 and 0 to 1, perhaps never both at 1: not known.
  EXPECT_THAT(with(checks + "scene.textures.t.type = add\nscene.textures.t.texture1 = c\n"
                            "scene.textures.t.texture2 = c\n"),
              IsEmpty());
}

TEST(SdlPhysical, TexturesOutOfAHardRange) {
  EXPECT_THAT(
      found("scene.textures.c.type = checkerboard3d\n"
            "scene.textures.c.mapping.type = globalmapping3d\n"
            "scene.textures.c.texture1 = 4\nscene.materials.a.type = glossy2\n"
            "scene.materials.a.uroughness = c\n"),
      ElementsAre(EndsWith("scene.materials.a.uroughness: wanted numbers in [0, 1], found a "
                           "texture that goes up to 4")));
}

TEST(SdlPhysical, OnlyWhatIsUsedIsSaid) {
  EXPECT_THAT(found("scene.materials.unused.kd = 7\nscene.materials.a.kd = 0.5\n"), IsEmpty());
  EXPECT_EQ(found("scene.materials.a.kd = 7\nscene.materials.b.kd = 0.5\n"
                  "scene.materials.m.type = mix\nscene.materials.m.material1 = a\n"
                  "scene.materials.m.material2 = b\n")
                .size(),
            1);
  // A colour that is clamped where the texture is read is said of the metal that has it.
  EXPECT_THAT(
      found("scene.textures.f.type = fresnelcolor\nscene.textures.f.kr = 2 1 1\n"
            "scene.materials.a.type = metal2\nscene.materials.a.fresnel = f\n"),
      ElementsAre(EndsWith("m.scn:2: scene.textures.f.kr: wanted numbers in [0, 1], found 2 "
                           "1 1: it gives back more light than it gets")));
}

/// What is found where every image's pixels go up to `most`, times its gain; `looked_at` counts
/// the images.
std::vector<std::string> found_by_pixels(std::string_view text, float most,
                                         const std::string& image = "t.png",
                                         int* looked_at = nullptr) {
  const ds::testing::SdlFolder folder;
  folder.write(image, "not read here");
  Scene scene = folder.material(std::string("scene.textures.t.type = imagemap\n") +
                                "scene.textures.t.file = " + image + "\n" + std::string(text));
  std::vector<std::string> lines = add_unphysical_of_pixels(scene, [&](const Image& read) {
    if (looked_at != nullptr) ++*looked_at;
    const float high = most * read.gain;
    return InputBounds{{0, 0, 0}, {high, high, high}};
  });
  for (const Material& material : scene.materials)
    EXPECT_EQ(material.unphysical.size(), lines.size());
  return lines;
}

TEST(SdlPhysical, AnImagesBrightestPixelTimesItsGainCounts) {
  const std::string gain = "scene.textures.t.gain = 4\nscene.materials.a.kd = t\n";
  EXPECT_THAT(found_by_pixels(gain, 0.5f),
              ElementsAre(EndsWith("m.scn:4: scene.materials.a.kd: wanted numbers in [0, 1], found "
                                   "a texture that goes up to 2: it gives back more light than it "
                                   "gets")));
  EXPECT_THAT(found_by_pixels(gain, 0.25f), IsEmpty());
  EXPECT_THAT(
      found_by_pixels("scene.textures.s.type = scale\nscene.textures.s.texture1 = t\n"
                      "scene.textures.s.texture2 = 1 3 1\nscene.materials.a.kd = s\n",
                      0.5f),
      ElementsAre(EndsWith("found a texture that goes up to 0.5 1.5 0.5: it gives back more "
                           "light than it gets")));
  // Floats have no greatest value.
  EXPECT_EQ(found_by_pixels("scene.materials.a.kd = t\n", 7, "t.exr").size(), 1);
  // White, but for rounding.
  EXPECT_THAT(found_by_pixels("scene.materials.a.kd = t\n", 1.00001f, "t.exr"), IsEmpty());
}

TEST(SdlPhysical, ImagesThatCannotBeTooBrightAreNotRead) {
  int looked_at = 0;
  for (const char* text :
       {"scene.materials.a.kd = t\n", "scene.textures.t.gain = 0.5\nscene.materials.a.kd = t\n"})
    EXPECT_THAT(found_by_pixels(text, 99, "t.png", &looked_at), IsEmpty());
  EXPECT_EQ(looked_at, 0);
}

TEST(SdlPhysical, ColoursOfMeshesReachToOne) {
  const std::string color = "scene.textures.c.type = hitpointcolor\n";
  EXPECT_THAT(found(color + "scene.materials.a.kd = c\n"), IsEmpty());
  EXPECT_THAT(found(color + "scene.textures.s.type = scale\nscene.textures.s.texture1 = c\n"
                            "scene.textures.s.texture2 = 2\nscene.materials.a.kd = s\n"),
              ElementsAre(EndsWith("found a texture that goes up to 2: it gives back more light "
                                   "than it gets")));
}

TEST(SdlPhysical, ThePixelsOfAMatteReachNoPrunedTexture) {
  // The material's own textures have other numbers than in the file.
  EXPECT_EQ(found_by_pixels("scene.textures.t.gain = 2\n"
                            "scene.textures.other.type = hitpointcolor\n"
                            "scene.materials.unused.kd = other\n"
                            "scene.textures.u.type = scale\nscene.textures.u.texture1 = t\n"
                            "scene.textures.u.texture2 = 2\nscene.materials.a.kd = u\n",
                            0.5f)
                .size(),
            1);
}

TEST(SdlPhysical, AnEnvironmentSaysItOnce) {
  const ds::testing::SdlFolder folder;
  ::testing::internal::CaptureStderr();
  folder.environment(std::string("scene.materials.body.kd = 3 3 3\n") +
                     "scene.lights.l.type = constantinfinite\n" +
                     std::string(ds::testing::k_square));
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(said,
              EndsWith("environment.scn:1: scene.materials.body.kd: wanted numbers in [0, 1], "
                       "found 3: it gives back more light than it gets\n"));
}

TEST(SdlWarnings, WhatNothingUsesIsSaid) {
  const ds::testing::SdlFolder folder;
  ::testing::internal::CaptureStderr();
  folder.material(
      "scene.textures.grain.type = fbm\n"
      "scene.textures.grain.mapping.type = globalmapping3d\n"
      "scene.materials.gloss.type = glossy2\nscene.materials.dull.type = matte\n");
  folder.environment(
      "scene.textures.grain.type = fbm\n"
      "scene.textures.grain.mapping.type = globalmapping3d\n"
      "scene.textures.index.type = fresnelcolor\n"
      "scene.materials.metal.type = metal2\nscene.materials.metal.fresnel = index\n"
      "scene.materials.body.type = matte\nscene.materials.body.kd = grain\n"
      "scene.shapes.ball.type = inlinedmesh\nscene.shapes.ball.vertices = 0 0 0 1 0 0 0 1 0\n"
      "scene.shapes.ball.faces = 0 1 2\n" +
      std::string(ds::testing::k_square) + "scene.lights.l.type = constantinfinite\n");
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(said, HasSubstr("m.scn:1: scene.textures.grain is used by nothing\n"));
  EXPECT_THAT(said, HasSubstr("m.scn:3: scene.materials.gloss is used by nothing: a material file "
                              "is for its last material, dull\n"));
  EXPECT_THAT(said, HasSubstr("environment.scn:4: scene.materials.metal is used by nothing\n"));
  EXPECT_THAT(said, HasSubstr("environment.scn:8: scene.shapes.ball is used by nothing\n"));
  // The light, the square, its material and texture, and what the metal reads are used.
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 4) << said;
}

TEST(SdlWarnings, APropertyThatStandsTwiceIsSaidOnce) {
  const ds::testing::SdlFolder folder;
  ::testing::internal::CaptureStderr();
  const Scene scene = folder.material("scene.materials.a.kd = 0.5\nscene.materials.a.kd = 0.25\n");
  EXPECT_EQ(scene.materials[0].inputs[0].constant.x, 0.25f);
  folder.write("environment.cfg",
               "film.imagepipeline.0.type = NOP\n"
               "film.imagepipeline.0.type = TONEMAP_LINEAR\n");
  folder.environment(
      "scene.lights.l.type = constantinfinite\nscene.lights.l.gain = 1 1 1\n\n"
      "scene.lights.l.gain = 2 2 2\n");
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(said,
              HasSubstr("m.scn:2: scene.materials.a.kd stands in line 1 already: the last one "
                        "counts\n"));
  EXPECT_THAT(said, HasSubstr("environment.scn:4: scene.lights.l.gain stands in line 2 already"));
  EXPECT_THAT(said, HasSubstr("environment.cfg:2: film.imagepipeline.0.type stands in line 1"));
}

}  // namespace
}  // namespace ds
