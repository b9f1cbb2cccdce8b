// SPDX-License-Identifier: Apache-2.0
// What a scene calls for, told with its reason: the list agrees with the program's text, and names
// the object, light or camera that calls.
#include "tracer/device/effects.h"

#include "tests/render/pictures.h"
#include "tracer/device/program_text.h"
#include "tracer/device/program_tokens.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ds {
namespace {

const Effect& find(const std::vector<Effect>& effects, std::string_view sort,
                   std::string_view name) {
  const auto found = std::find_if(effects.begin(), effects.end(), [&](const Effect& effect) {
    return effect.sort == sort && effect.name == name;
  });
  if (found == effects.end()) throw std::runtime_error("no effect " + std::string(name));
  return *found;
}

/// A quad of every material type, alone.
std::vector<pictures::Picture> scenes() {
  std::vector<pictures::Picture> list = pictures::all_effects();
  for (const NodeType& type : material_types()) {
    pictures::Picture p{std::string(type.name), {}, {}, {}};
    pictures::add_matte(p.scene, {1, 1, 1});
    pictures::add_matte(p.scene, {1, 1, 1});
    pictures::add_object(p.scene, pictures::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                         pictures::add_material(p.scene, type.name));
    list.push_back(p);
  }
  return list;
}

TEST(Effects, AreSimulatedWhereTheProgramHoldsTheirCode) {
  for (const pictures::Picture& p : scenes()) {
    const std::vector<Effect> effects = effects_of(p.scene, p.camera);
    const std::string text = program_tokens(path_program_text(scene_effects(p.scene, p.camera)));
    const auto has = [&](const std::string& code) { return text.find(code) != text.npos; };
    for (const NodeType& type : material_types()) {
      const std::string code =
          " " + std::string(type.kernel_prefix) + (type.children > 0 ? "_child(" : "_sample(");
      EXPECT_EQ(find(effects, "material", type.name).simulated, has(code)) << p.name << type.name;
    }
    for (const NodeType& type : texture_types())
      EXPECT_EQ(find(effects, "texture", type.name).simulated,
                has(" " + std::string(type.kernel_prefix) + "_evaluate("))
          << p.name << type.name;
    for (const std::string& kind : all_effects().lights)
      EXPECT_EQ(find(effects, "light", kind).simulated, has(" " + kind + "_sample("))
          << p.name << kind;
    EXPECT_EQ(find(effects, "camera", "lens").simulated, has("#define DS_LENS\n"));
    EXPECT_EQ(find(effects, "camera", "camera-invisible objects").simulated,
              has("#define DS_CAMERA_INVISIBLE\n"));
    EXPECT_EQ(find(effects, "transport", "sampling of lights").simulated,
              has("#define DS_LIGHTS_SAMPLED\n"));
    EXPECT_EQ(find(effects, "transport", "light from beyond the scene").simulated,
              has("#define DS_ESCAPE_LIGHTS("));
    EXPECT_EQ(find(effects, "transport", "choice among lobes").simulated,
              has("#define DS_LOBE_CHOICE\n"));
    EXPECT_EQ(find(effects, "transport", "guide to caustics").simulated,
              has("#define DS_GUIDED(type)"));
  }
}

TEST(Effects, EachIsSimulatedInSomeSceneAndLeftOutInAnother) {
  std::vector<Effect> on, off;
  for (const pictures::Picture& p : scenes())
    for (const Effect& effect : effects_of(p.scene, p.camera))
      (effect.simulated ? on : off).push_back(effect);
  for (const Effect& effect : effects_of(scenes()[0].scene, {})) {
    EXPECT_NO_THROW(find(on, effect.sort, effect.name)) << effect.name;
    EXPECT_NO_THROW(find(off, effect.sort, effect.name)) << effect.name;
  }
}

TEST(Effects, TheReasonNamesWhatCalls) {
  Scene scene;
  const TextureRef veins{{}, pictures::add_texture(scene, "marble", {})};
  scene.textures.back().name = "veins";
  const int material = pictures::add_matte(scene, {1, 1, 1});
  scene.materials.back().name = "stone";
  scene.materials.back().inputs[0] = veins;
  pictures::add_material(scene, "glass");
  pictures::add_texture(scene, "fbm", {});
  pictures::add_object(scene, pictures::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), material);
  scene.objects.back().name = "table";
  scene.objects.back().camera_invisible = true;
  scene.lights.push_back(pictures::sun_light({0, 0, 1}, 1, {1, 1, 1}));
  scene.lights.back().name = "noon";
  Camera camera;
  camera.lens_radius_m = 0.25;
  const std::vector<Effect> effects = effects_of(scene, camera);
  EXPECT_EQ(find(effects, "material", "matte").why, "material stone of object table");
  EXPECT_EQ(find(effects, "material", "glass").why, "no object shows it");
  EXPECT_EQ(find(effects, "material", "mirror").why, "no material is of this type");
  EXPECT_EQ(find(effects, "texture", "marble").why, "texture veins of material stone");
  EXPECT_EQ(find(effects, "texture", "fbm").why, "no material that is shown uses it");
  EXPECT_EQ(find(effects, "light", "sun").why, "light noon");
  EXPECT_EQ(find(effects, "light", "mesh").why, "no object emits");
  scene.lights[0].color = {0, 0, 0};
  scene.materials[static_cast<std::size_t>(material)].emits = true;
  const std::vector<Effect> dark = effects_of(scene, camera);
  EXPECT_FALSE(find(dark, "light", "sun").simulated);
  EXPECT_EQ(find(dark, "light", "sun").why, "light noon is black");
  EXPECT_EQ(find(dark, "light", "mesh").why, "object table emits black");
  EXPECT_EQ(find(dark, "transport", "sampling of lights").why, "there is no light");
  EXPECT_EQ(find(effects, "camera", "lens").why, "lens radius 0.25 m");
  EXPECT_EQ(find(effects, "camera", "camera-invisible objects").why, "object table");
  EXPECT_EQ(find(effects, "transport", "sampling of lights").why, "sun");
  EXPECT_EQ(find(effects, "transport", "choice among lobes").why,
            "every material shown has one lobe");
}

TEST(Effects, AConstantSkyAloneIsNotSampled) {
  Scene scene;
  pictures::add_object(scene, pictures::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                       pictures::add_matte(scene, {1, 1, 1}));
  scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  const Effect sampling = find(effects_of(scene, {}), "transport", "sampling of lights");
  EXPECT_FALSE(sampling.simulated);
  EXPECT_EQ(sampling.why, "scattered rays find a constant sky as well");
}

}  // namespace
}  // namespace ds
