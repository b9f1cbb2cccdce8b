// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/sdl_files_for_tests.h"
#include "tracer/scene/sdl_parameters.h"

#include <gtest/gtest.h>

namespace ds {
namespace {

using ::ds::testing::SdlFolder;

/// "matte, glossy2, ...": whatever the tables hold.
std::string types(const SdlSection& section) {
  return fmt::format("{}", fmt::join(type_names(section), ", "));
}

struct Case {
  const char* text;
  std::string message;
};

class MaterialErrors : public ::testing::TestWithParam<Case> {};

TEST_P(MaterialErrors, SayWhatWasWantedAndFound) {
  const SdlFolder folder;
  EXPECT_EQ(folder.material_error(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, MaterialErrors,
    ::testing::Values(
        Case{"", "m.scn: wanted a material, found no scene.materials"},
        Case{"scene.materials.a.type = cloth\nscene.materials.a.kd = 1\n",
             std::string("m.scn:1: scene.materials.a.type: material type \"cloth\" is not "
                         "supported yet; there "
                         "are ") +
                 types(material_section())},
        Case{"scene.materials.a.type = plastic",
             std::string(
                 "m.scn:1: scene.materials.a.type: material type \"plastic\" is unknown; there are "
                 "") +
                 types(material_section())},
        Case{"scene.textures.t.type = brick\nscene.materials.a.kd = 1",
             std::string("m.scn:1: scene.textures.t.type: texture type \"brick\" is not supported "
                         "yet; there are ") +
                 types(texture_section())},
        Case{"scene.textures.t.type = wood\nscene.materials.a.kd = 1",
             std::string(
                 "m.scn:1: scene.textures.t.type: texture type \"wood\" is unknown; there are ") +
                 types(texture_section())},
        Case{"scene.materials.a.type = matte\nscene.materials.a.ks = 1",
             "m.scn:2: scene.materials.a.ks is unknown to a material of type matte; it has kd, "
             "emission, id"},
        Case{"scene.materials.a.kd = 1\nscene.materials.a.bumptex = t",
             "m.scn:2: scene.materials.a.bumptex = t is not supported yet"},
        Case{"scene.materials.a.kd = 1\nscene.materials.a.transparency = 0.5",
             "m.scn:2: scene.materials.a.transparency = 0.5 is not supported yet"},
        Case{"scene.materials.a.kd = 1\nscene.materials.a.emission.theta = 45",
             "m.scn:2: scene.materials.a.emission.theta = 45 is not supported yet"},
        Case{"scene.materials.a.type = glass\nscene.materials.a.cauchyb = 0.01",
             "m.scn:2: scene.materials.a.cauchyb = 0.01 is not supported yet"},
        Case{"scene.materials.a.type = glass\nscene.materials.a.filmthickness = 1",
             "m.scn:2: scene.materials.a.filmthickness = 1 is not supported yet"},
        Case{"scene.materials.a.kd = 1 2",
             "m.scn:1: scene.materials.a.kd: wanted one or three numbers >= 0 or a texture's name, "
             "found \"1 2\""},
        Case{"scene.materials.a.kd = 1e39",
             "m.scn:1: scene.materials.a.kd: wanted one or three numbers >= 0 or a texture's name, "
             "found \"1e39\""},
        Case{"scene.materials.a.kd = nan",
             "m.scn:1: scene.materials.a.kd: wanted one or three numbers >= 0 or a texture's name, "
             "found \"nan\""},
        Case{"scene.materials.a.kd = opencolorio cfg space 1 1 1",
             "m.scn:1: scene.materials.a.kd: colour space of \"opencolorio cfg space 1 1 1\" is "
             "not supported yet"},
        Case{"scene.materials.a.type = glossy2\nscene.materials.a.doublesided = maybe",
             "m.scn:2: scene.materials.a.doublesided: wanted 0, 1, true or false, found \"maybe\""},
        Case{"scene.textures.a.type = scale\nscene.textures.a.texture1 = b\n"
             "scene.textures.b.type = fbm\nscene.textures.b.mapping.type = globalmapping3d\n"
             "scene.materials.m.kd = a",
             "m.scn:2: scene.textures.a.texture1: texture \"b\" cannot be used here: it is defined "
             "below its use"},
        Case{"scene.materials.a.type = mix\nscene.materials.a.material1 = "
             "b\nscene.materials.a.material2 = b\n"
             "scene.materials.b.kd = 1",
             "m.scn:2: scene.materials.a.material1: material \"b\" is not defined above"},
        Case{"scene.materials.b.emission = 1\nscene.materials.a.type = mix\n"
             "scene.materials.a.material1 = b\n",
             "m.scn:3: scene.materials.a.material1: a mix of the material \"b\", which emits "
             "light, is not supported "
             "yet\nm.scn:2: scene.materials.a: material2 is missing"},
        Case{"scene.materials.a.type = metal2\nscene.materials.a.preset = mithril",
             "m.scn:2: scene.materials.a.preset: wanted aluminium, amorphous carbon, copper, "
             "gold or silver, found \"mithril\""},
        Case{"scene.materials.a.type = metal2\nscene.materials.a.fresnel = f",
             "m.scn:2: scene.materials.a.fresnel: texture \"f\" is not defined above"},
        Case{"scene.materials.a.emission = 1\nscene.materials.a.emission.power = 10\n"
             "scene.materials.a.emission.efficiency = 1",
             "m.scn:2: scene.materials.a.emission.power: needs the area of an object, and a "
             "material file has none: "
             "use emission.gain"},
        Case{"scene.textures.t.type = hitpointcolor\nscene.materials.a.emission = t\n"
             "scene.materials.a.emission.gain.normalizebycolor = 1",
             "m.scn:2: scene.materials.a.emission: a texture that emits is not supported yet, "
             "wanted a number or a colour, found t"},
        Case{"scene.textures.t.file = no.png\nscene.materials.a.kd = t",
             "m.scn:1: scene.textures.t.file: file no.png does not exist"},
        Case{"scene.textures.t.file = .\nscene.materials.a.kd = t",
             "m.scn:1: scene.textures.t.file: wanted a file, found a folder or a device: ."},
        Case{"scene.textures.t.type = marble\nscene.materials.a.kd = t",
             "m.scn:1: scene.textures.t: mapping.type is missing: only globalmapping3d is "
             "supported, "
             "and LuxCore takes uvmapping3d without it"},
        Case{"scene.objects.a.ply = a.ply\nscene.materials.a.kd = 1",
             "m.scn:1: scene.objects.a.ply does not belong in a material file"},
        Case{"scene.camera.type = perspective\nscene.materials.a.kd = 1",
             "m.scn:1: scene.camera.type does not belong here: the camera is in the recipe"},
        Case{"scene.volumes.v.type = clear\nscene.materials.a.kd = 1",
             "m.scn:1: scene.volumes.v.type is not supported yet"},
        Case{"hello.world = 1\nscene.materials.a.kd = 1", "m.scn:1: hello.world is unknown"},
        Case{"scene.materials.a = 1\nscene.materials.b.kd = 1",
             "m.scn:1: scene.materials.a is unknown: wanted a property of a material"}));

class EnvironmentErrors : public ::testing::TestWithParam<Case> {};

TEST_P(EnvironmentErrors, SayWhatWasWantedAndFound) {
  const SdlFolder folder;
  EXPECT_EQ(folder.environment_error(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, EnvironmentErrors,
    ::testing::Values(
        Case{"scene.lights.l.type = laser",
             std::string("environment.scn:1: scene.lights.l.type: light type \"laser\" is not "
                         "supported yet; there are ") +
                 types(light_section())},
        Case{"scene.lights.l.type = area",
             std::string("environment.scn:1: scene.lights.l.type: light type \"area\" is unknown; "
                         "there are ") +
                 types(light_section())},
        Case{"scene.lights.l.type = point\nscene.lights.l.iesfile = a.ies",
             "environment.scn:2: scene.lights.l.iesfile = a.ies is not supported yet"},
        Case{"scene.lights.l.type = sun\nscene.lights.l.color = 1 1 1",
             "environment.scn:2: scene.lights.l.color is unknown to a light of type sun; it has "
             "dir, turbidity, relsize, transformation, gain, temperature"},
        Case{"scene.lights.l.type = sun\nscene.lights.l.dir = 1 0 -1",
             "environment.scn:2: scene.lights.l.dir: wanted a sun above the horizon, found z = "
             "-0.7071067811865475"},
        Case{"scene.lights.l.type = point\nscene.lights.l.gain = 1",
             "environment.scn:2: scene.lights.l.gain: wanted three numbers >= 0, "
             "found \"1\""},
        Case{"scene.lights.l.type = spot\nscene.lights.l.coneangle = 90",
             "environment.scn:2: scene.lights.l.coneangle: wanted a number in (0, 90), "
             "found \"90\""},
        Case{"scene.lights.l.type = infinite",
             "environment.scn:1: scene.lights.l: file is missing"},
        Case{"scene.shapes.s.type = strands",
             "environment.scn:1: scene.shapes.s.type: shape type \"strands\" is not supported yet; "
             "there "
             "are mesh, inlinedmesh"},
        Case{"scene.materials.m.kd = 1\nscene.objects.o.material = m\n",
             "environment.scn:2: scene.objects.o: wanted one of ply, shape and vertices, found 0"},
        Case{"scene.objects.o.vertices = 0 0 0 1 0 0 0 1 0\nscene.objects.o.faces = 0 1 2",
             "environment.scn:1: scene.objects.o: material is missing"},
        Case{"scene.materials.m.kd = 1\nscene.objects.o.material = m\n"
             "scene.objects.o.vertices = 0 0 0 1 0 0 0 1 0\nscene.objects.o.faces = 0 1 3",
             "environment.scn:4: scene.objects.o.faces: wanted indices below 3, found 3"},
        Case{
            "scene.materials.m.kd = 1\nscene.objects.o.material = m\n"
            "scene.objects.o.vertices = 0 0 0 1 0 0 0 1\nscene.objects.o.faces = 0 1 1",
            "environment.scn:3: scene.objects.o.vertices: wanted a multiple of 3 numbers, found 8"},
        Case{"scene.materials.m.kd = 1\nscene.objects.o.material = m\nscene.objects.o.id = 1\n"
             "scene.objects.o.vertices = 0 0 0 1 0 0 0 1 0\nscene.objects.o.faces = 0 1 2",
             "environment.scn:3: scene.objects.o.id: 1 is the id of the dataset's model, take "
             "another"},
        Case{"scene.materials.m.kd = 1\nscene.objects.o.material = m\n"
             "scene.objects.o.transformation = 1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1\n"
             "scene.objects.o.vertices = 0 0 0 1 0 0 0 1 0\nscene.objects.o.faces = 0 1 2",
             "environment.scn:3: scene.objects.o.transformation: wanted an affine matrix column by "
             "column, found 5 0 "
             "0 1 as its last row"},
        Case{"scene.materials.m.kd = 1\nscene.objects.o.material = m\n"
             "scene.objects.o.motion.0.time = 0\n"
             "scene.objects.o.vertices = 0 0 0 1 0 0 0 1 0\nscene.objects.o.faces = 0 1 2",
             "environment.scn:3: scene.objects.o.motion.0.time = 0 is not supported yet"}));

TEST(SdlErrors, AMissingFileIsSaid) {
  const SdlFolder folder;
  EXPECT_THROW(read_material(folder.path() / "no.scn"), Error);
  EXPECT_THROW(read_environment(folder.path() / "no"), Error);
}

TEST(SdlErrors, AllFindingsAreReportedTogether) {
  const SdlFolder folder;
  EXPECT_EQ(
      folder.material_error("broken\nscene.materials.a.type = cloth\nscene.materials.b.kd = x\n"),
      std::string("m.scn:1: wanted \"name = values\", found \"broken\"\n") +
          "m.scn:2: scene.materials.a.type: material type \"cloth\" is not supported yet; there "
          "are " +
          types(material_section()) +
          "\n"
          "m.scn:3: scene.materials.b.kd: wanted one or three numbers >= 0 or a texture's name, "
          "found \"x\"");
}

TEST(SdlErrors, AnHdrImageNeedsNoGammaAndTakesNoOther) {
  const SdlFolder folder;
  const std::string light = "scene.lights.l.type = infinite\nscene.lights.l.file = ";
  for (const char* file : {"sky.exr", "sky.HDR", "sky.pfm"}) {
    folder.write(file, "not read here");
    EXPECT_EQ(folder.environment(light + file).images.at(0).gamma, 1.0f) << file;
  }
  for (const char* gamma : {"gamma", "colorspace.gamma"}) {
    EXPECT_EQ(folder.environment_error(light + "sky.exr\nscene.lights.l." + gamma + " = 1\n"), "");
    EXPECT_EQ(folder.environment_error(light + "sky.exr\nscene.lights.l." + gamma + " = 2.2\n"),
              std::string("environment.scn:3: scene.lights.l.") + gamma +
                  ": wanted 1 or nothing for the HDR image sky.exr, found 2.2");
  }
  folder.write("sky.png", "not read here");
  EXPECT_EQ(folder.environment(light + "sky.png").images.at(0).gamma, 2.2f);
}

// One mistake is one finding, and says what was most likely meant.
INSTANTIATE_TEST_SUITE_P(
    Slips, MaterialErrors,
    ::testing::Values(
        Case{"scene.materials.a.type = galss\nscene.materials.a.kr = 1\nscene.materials.a.kt = 1",
             "m.scn:1: scene.materials.a.type: material type \"galss\" is unknown, did you mean "
             "glass?"},
        Case{"scene.materials.a.tpye = glass\nscene.materials.a.kr = 1\n"
             "scene.materials.a.interiorior = 1.3",
             "m.scn:1: scene.materials.a.tpye is unknown to a material, did you mean type?"},
        Case{"scene.materials.a.kr = 1\nscene.materials.a.kt = 1\n"
             "scene.materials.a.interiorior = 1.3",
             "m.scn:1: scene.materials.a.kr (and kt, interiorior) is unknown to a material of type "
             "matte, which it is without a type; it has kd, emission, id"},
        Case{"scene.material.a.type = matte\nscene.material.a.kd = 0.5\nscene.material.a.ks = 1",
             "m.scn:1: scene.material is no section of a scene, did you mean scene.materials?\n"
             "m.scn:3: scene.materials.a.ks is unknown to a material of type matte; it has kd, "
             "emission, id"},
        Case{"scene.text = a\nscene.epsilom = 1\nscene.materials.a.kd = 1",
             "m.scn:1: scene.text is unknown\nm.scn:2: scene.epsilom is unknown"},
        Case{"scene.materials.a.type = metal2\nscene.materials.a.uroughnes = 0.1\n"
             "scene.materials.a.emision = 1",
             "m.scn:2: scene.materials.a.uroughnes is unknown to a material, did you mean "
             "uroughness?\n"
             "m.scn:3: scene.materials.a.emision is unknown to a material, did you mean emission?"},
        Case{"scene.materials.a.type = metal2\nscene.materials.a.preset = sliver",
             "m.scn:2: scene.materials.a.preset: wanted aluminium, amorphous carbon, copper, gold "
             "or silver, found \"sliver\", did you mean silver?"},
        Case{"scene.textures.stone.type = scale\nscene.materials.a.kd = stoen",
             "m.scn:2: scene.materials.a.kd: wanted one or three numbers >= 0 or a texture's name, "
             "found \"stoen\", did you mean stone?"},
        Case{"scene.materials.b.kd = 1\nscene.materials.a.type = mix\n"
             "scene.materials.a.materail1 = b\nscene.materials.a.material2 = b",
             "m.scn:3: scene.materials.a.materail1 is unknown to a material, did you mean "
             "material1?"},
        Case{"scene.textures.t.file = no.png\nscene.textures.s.file = no.png\n"
             "scene.textures.u.type = scale\nscene.textures.u.texture1 = t\n"
             "scene.materials.a.kd = u\nscene.materials.b.kd = s",
             "m.scn:1: scene.textures.t.file: file no.png does not exist"},
        Case{"scene.textures.t.type = brik\nscene.textures.t.brickwidth = 1\n"
             "scene.textures.u.type = scale\nscene.textures.u.texture1 = t\n"
             "scene.materials.a.kd = u\nscene.materials.b.kd = t",
             std::string(
                 "m.scn:1: scene.textures.t.type: texture type \"brik\" is unknown; there are ") +
                 types(texture_section())},
        Case{"scene.textures.t.type = marble\nscene.textures.t.maping.type = globalmapping3d\n"
             "scene.materials.a.kd = t",
             "m.scn:2: scene.textures.t.maping.type is unknown to a texture, did you mean "
             "mapping.type?"},
        Case{
            "scene.materials.a.type = metal2\nscene.materials.a.uroughness = 1.5",
            "m.scn:2: scene.materials.a.uroughness: wanted a number in [0, 1] or a texture's name, "
            "found \"1.5\""},
        Case{"scene.materials.a.type = metal2\nscene.materials.a.preset = gold\n"
             "scene.materials.a.name = gold",
             "m.scn:3: scene.materials.a.name has no effect beside the material's other "
             "properties"},
        // A name that lost its hyphen is another material: the one that counts, or one that is spare.
        Case{"scene.materials.red-plastic.type = glossy2\nscene.materials.red-plastic.ks = .04\n"
             "scene.materials.redplastic.kd = 0.5 0 0",
             "m.scn:3: scene.materials.redplastic has no type and is another material than "
             "red-plastic, did you mean scene.materials.red-plastic?"},
        Case{"scene.materials.redplastic.kd = 0.5 0 0\nscene.materials.red-plastic.type = glossy2",
             "m.scn:1: scene.materials.redplastic has no type and is another material than "
             "red-plastic, did you mean scene.materials.red-plastic?"},
        Case{"scene.materials.wall1.kd = 1\nscene.materials.wall2.type = matte", ""},
        Case{"scene.camera.type = perspective\nscene.camera.up = 0 0 1\n"
             "scene.camera.fieldofview = 45\nscene.materials.a.kd = 1",
             "m.scn:1: scene.camera.type does not belong here: the camera is in the recipe"}));

INSTANTIATE_TEST_SUITE_P(
    Slips, EnvironmentErrors,
    ::testing::Values(
        Case{
            "scene.lights.l.type = piont",
            "environment.scn:1: scene.lights.l.type: light type \"piont\" is unknown, did you mean "
            "point?"},
        // Without the slip it would be a sky of its own.
        Case{"scene.lights.lamp.type = point\nscene.lights.lmap.gain = 2 2 2",
             "environment.scn:2: scene.lights.lmap has no type and is another light than lamp, did "
             "you mean scene.lights.lamp?"},
        Case{"scene.materials.floor.type = glossy2\nscene.materials.flor.kd = 0.5\n"
             "scene.objects.o.material = floor\n"
             "scene.objects.o.vertices = 0 0 0 1 0 0 0 1 0\nscene.objects.o.faces = 0 1 2",
             "environment.scn:2: scene.materials.flor has no type and is another material than "
             "floor, did you mean scene.materials.floor?"},
        Case{"scene.lights.l.type = infinite\nscene.lights.l.flie = sky.exr",
             "environment.scn:2: scene.lights.l.flie is unknown to a light, did you mean file?"},
        Case{"scene.materials.body.kd = 1\n"
             "scene.objects.o.material = bdoy\nscene.objects.o.vertices = 0 0 0 1 0 0 0 1 0\n"
             "scene.objects.o.faces = 0 1 2\n"
             "scene.objects.p.material = bdoy\nscene.objects.p.vertices = 0 0 0 1 0 0 0 1 0\n"
             "scene.objects.p.faces = 0 1 2",
             "environment.scn:2: scene.objects.o.material: material \"bdoy\" is not defined above, "
             "did you mean body?"},
        Case{"scene.materials.m.type = galss\nscene.objects.o.material = m\n"
             "scene.objects.o.vertices = 0 0 0 1 0 0 0 1 0\nscene.objects.o.faces = 0 1 2",
             "environment.scn:1: scene.materials.m.type: material type \"galss\" is unknown, did "
             "you "
             "mean glass?"},
        Case{"scene.materials.m.kd = 1\nscene.shapes.s.ply = no.ply\n"
             "scene.objects.o.material = m\nscene.objects.o.shape = s\n"
             "scene.objects.p.material = m\nscene.objects.p.ply = no.ply",
             "environment.scn:2: scene.shapes.s.ply: file no.ply does not exist"},
        Case{"scene.materials.m.kd = 1\nscene.objects.o.material = m\nscene.objects.o.pyl = a.ply",
             "environment.scn:3: scene.objects.o.pyl is unknown to an object, did you mean ply?"},
        Case{"scene.object.o.material = m\nscene.materials.m.kd = 1\nscene.object.o.ply = no.ply",
             "environment.scn:1: scene.object is no section of a scene, did you mean "
             "scene.objects?\n"
             "environment.scn:3: scene.objects.o.ply: file no.ply does not exist"}));

TEST(SdlErrors, FilmFile) {
  const SdlFolder folder;
  folder.write(
      "environment.cfg",
      "film.imagepipeline.0.type = BLOOM\nfilm.imagepipeline.1.type = SEPIA\nfilm.width = 640\n"
      "film.imagepipeline.2.type = TONEMAP_LINEAR\nfilm.imagepipeline.2.scale = 0\n"
      "film.imagepipeline.2.gain = 1\nsampler.type = SOBOL\n");
  EXPECT_EQ(
      folder.environment_error(""),
      "environment.cfg:1: film.imagepipeline.0.type: image pipeline step type \"BLOOM\" is not "
      "supported yet; there are TONEMAP_LINEAR, TONEMAP_REINHARD02, TONEMAP_AUTOLINEAR, "
      "GAMMA_CORRECTION, NOP\n"
      "environment.cfg:2: film.imagepipeline.1.type: image pipeline step type \"SEPIA\" is "
      "unknown; there are TONEMAP_LINEAR, TONEMAP_REINHARD02, TONEMAP_AUTOLINEAR, "
      "GAMMA_CORRECTION, NOP\n"
      "environment.cfg:5: film.imagepipeline.2.scale: wanted a number > 0, found \"0\"\n"
      "environment.cfg:3: film.width does not belong here: only film.imagepipeline does, the rest "
      "is in the "
      "recipe\n"
      "environment.cfg:7: sampler.type does not belong here: the engine is in the recipe\n"
      "environment.cfg:6: film.imagepipeline.2.gain is unknown to an image pipeline step of type "
      "TONEMAP_LINEAR; it has scale");
}

}  // namespace
}  // namespace ds
