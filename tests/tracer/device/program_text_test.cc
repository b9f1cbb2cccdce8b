// SPDX-License-Identifier: Apache-2.0
// The text of specialised programs: it holds what a scene calls for and nothing else, since the
// render key takes it.
#include "tracer/device/program_text.h"

#include "tests/render/pictures.h"
#include "tracer/base/error.h"
#include "tracer/device/plane_types.h"
#include "tracer/device/program_assembly.h"
#include "tracer/device/program_tokens.h"
#include "tracer/kernels/embedded.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <regex>
#include <set>
#include <span>

namespace ds {
namespace {

Scene scene_of(const std::vector<std::string_view>& materials) {
  Scene scene;
  for (const std::string_view type : materials)
    pictures::add_object(scene, pictures::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                         pictures::add_material(scene, type));
  scene.lights.push_back(pictures::point_light({0, 0, 1}, {1, 1, 1}));
  return scene;
}

std::string text_of(const Scene& scene, const Camera& camera = {}) {
  return program_tokens(path_program_text(scene_effects(scene, camera)));
}

std::size_t count_of(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST(ProgramText, HoldsNoMaterialThatTheSceneDoesNotShow) {
  for (const NodeType& shown : material_types()) {
    if (shown.name == "mix") continue;
    const std::string text = text_of(scene_of({shown.name}));
    for (const NodeType& other : material_types())
      EXPECT_EQ(text.find(" " + std::string(other.kernel_prefix) + "_sample(") != text.npos,
                other.name == shown.name)
          << shown.name << " and " << other.name;
  }
  // An edit of glass's file therefore changes no key of a scene without glass.
  EXPECT_EQ(text_of(scene_of({"matte"})).find("glass"), std::string::npos);
}

TEST(ProgramText, MaterialsThatNothingShowsAreLeftOut) {
  Scene scene = scene_of({"matte"});
  pictures::add_material(scene, "glass");
  EXPECT_EQ(text_of(scene), text_of(scene_of({"matte"})));
  // A mix shows its parts.
  pictures::add_object(scene, pictures::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                       pictures::add_material(scene, "mix"));
  EXPECT_NE(text_of(scene).find("glass_sample"), std::string::npos);
}

TEST(ProgramText, LightsTexturesAndLensAreThereWhereCalledFor) {
  Scene scene = scene_of({"matte"});
  const std::string plain = text_of(scene);
  for (const char* word : {"sun_", "spot_", "infinite_", "mesh_sample", "checkerboard",
                           "DS_TEXTURES(X)", "#define DS_LENS"})
    EXPECT_EQ(plain.find(std::string("\n") + word), std::string::npos) << word;
  EXPECT_EQ(plain.find("infinite_escape"), std::string::npos);
  Camera lens;
  lens.lens_radius_m = 0.01;
  EXPECT_NE(text_of(scene, lens), plain);
  Scene sunny = scene;
  sunny.lights.push_back(pictures::sun_light({0, 0, 1}, 1, {1, 1, 1}));
  EXPECT_NE(text_of(sunny).find("sun_escape"), std::string::npos);
  Scene textured = scene;
  textured.materials[0].inputs[0] = {{}, pictures::add_texture(textured, "marble", {})};
  EXPECT_NE(text_of(textured).find("marble_evaluate"), std::string::npos);
  EXPECT_EQ(text_of(textured).find("checkerboard3d_evaluate"), std::string::npos);
}

TEST(ProgramText, EqualEffectsMakeEqualTexts) {
  // Whatever the order, the numbers and the geometry.
  const std::string text = text_of(scene_of({"matte", "glossy2", "glass"}));
  EXPECT_EQ(text_of(scene_of({"glass", "matte", "glossy2", "glass"})), text);
  Scene moved = scene_of({"glossy2", "glass", "matte"});
  pictures::set_input(moved, 0, "kd", {0.1f, 0.2f, 0.3f});
  moved.objects[0].mesh = pictures::sphere({3, 2, 1}, 2, 9, true);
  moved.lights.push_back(pictures::point_light({5, 5, 5}, {9, 9, 9}));
  EXPECT_EQ(text_of(moved), text);
}

std::string all_planes_text() {
  std::vector<const PlaneType*> all;
  for (const PlaneType& plane : plane_types())
    if (!is_of_light(plane)) all.push_back(&plane);
  return planes_program_text(all, all_effects());
}

TEST(ProgramText, HooksAreInNoProgramThatDoesNotAskForThem) {
  const SceneEffects plain = scene_effects(scene_of({"matte", "glossy2", "mix"}), {});
  const std::string text = program_tokens(path_program_text(plain));
  EXPECT_EQ(text.find("DS_HOOK"), std::string::npos);
  for (const char* word : {"_albedo(", "_second(", "_diffuse(", "contribute(", "light_film"})
    EXPECT_EQ(text.find(word), std::string::npos) << word;
  // What they leave is the program itself, in whole blocks.
  EXPECT_EQ(count_of(text, "#if"), count_of(text, "#endif"));
  const std::array planes{&plane_type("direct_glossy")};
  const std::string lit = program_tokens(path_program_text(with_light_planes(plain, planes)));
  for (const char* word : {"_diffuse(", "contribute(", "light_film", "direct_glossy_takes("})
    EXPECT_NE(lit.find(word), std::string::npos) << word;
  for (const char* word : {"_albedo(", "_second(", "emission_takes(", "direct_diffuse_takes("})
    EXPECT_EQ(lit.find(word), std::string::npos) << word;
}

TEST(ProgramText, HoldsNothingOfTheHost) {
  // Help, defaults and ranges of a light's properties stand in its header, and are in no key.
  const std::string text = program_tokens(path_program_text(all_effects()));
  for (const char* word : {"DS_HOOK", "LightOnHost", "LightInput", "sun_power"})
    EXPECT_EQ(text.find(word), std::string::npos) << word;
  EXPECT_NE(text.find("sun_sample"), std::string::npos);
}

TEST(ProgramText, EveryFileStandsInItOnce) {
  SceneEffects effects = all_effects();
  effects.light_planes = {"emission"};
  const std::string text = path_program_text(effects);
  for (const EmbeddedFile& file : std::span(k_embedded_files, k_embedded_file_count)) {
    // The first line of code of each file that is part of the whole program.
    if (std::string_view(file.path).ends_with("first_hit.cl") ||
        std::string_view(file.path).ends_with("packet.cl") ||
        std::string_view(file.path).ends_with("kernels/albedo.h") ||
        std::string_view(file.path).find("/plane") != std::string_view::npos ||
        std::string_view(file.path).ends_with("rays.cl"))
      continue;
    std::string_view body = file.text;
    const std::size_t enumeration = body.find("DS_FN ");
    if (enumeration == body.npos) continue;
    const std::string_view declaration =
        body.substr(enumeration, body.find(')', enumeration) - enumeration);
    // A file may declare it twice itself, in branches of an #if.
    EXPECT_EQ(count_of(text, declaration), count_of(body, declaration))
        << file.path << ": " << declaration;
  }
  EXPECT_EQ(text.find("#include"), std::string::npos);
  EXPECT_EQ(text.find("#pragma once"), std::string::npos);
}

TEST(ProgramText, NoBuiltInTranscendentalIsCalled) {
  // They give other bits on other devices.
  const std::string text =
      program_tokens(path_program_text(all_effects()) + all_planes_text() + rays_program_text());
  const std::regex builtin(
      R"(\b(native_|half_)?(sin|cos|tan|exp2?|exp10|log2?|log10|powr?|pown|asin|acos|atan2?|rsqrt|cbrt|hypot|normalize|fast_\w+|mad)\s*\()");
  std::smatch match;
  EXPECT_FALSE(std::regex_search(text, match, builtin)) << match.str();
}

TEST(ProgramText, StrictProgramsSwitchContractionOff) {
  for (const std::string& text :
       {path_program_text(all_effects()), all_planes_text(), rays_program_text()})
    EXPECT_NE(text.find("pragma OPENCL FP_CONTRACT OFF"), std::string::npos);
}

TEST(Assemble, AMissingFileIsNamed) {
  try {
    assemble("", std::vector<std::string>{"tracer/kernels/none.cl"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("tracer/kernels/none.cl"), std::string::npos);
  }
}

}  // namespace
}  // namespace ds
