// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_physical.h"

#include "tests/tracer/scene/sdl_files_for_tests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ds {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
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

}  // namespace
}  // namespace ds
