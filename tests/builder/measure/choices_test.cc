// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/choices.h"

#include "builder/measure/effect_choices.h"
#include "builder/measure/material_albedo.h"
#include "builder/measure/texture_mean.h"
#include "tests/render/pictures.h"
#include "tracer/device/program_text.h"
#include "tracer/scene/type_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>

namespace ds {
namespace {

using testing::Contains;
using testing::Not;

/// A checkerboard of 1 and 0 on a square metre of matte floor, under a spot, with a coated ball.
Subject subject() {
  Subject s;
  const int board = pictures::add_texture(s.scene, "checkerboard3d", {});
  s.scene.textures[0].name = "board";
  s.scene.textures[0].inputs[0] = {{1, 1, 1}, -1};
  s.scene.textures[0].inputs[1] = {{0, 0, 0}, -1};
  const int floor = pictures::add_matte(s.scene, {0.5f, 0.5f, 0.5f});
  const int ball = pictures::add_material(s.scene, "glossy2");
  s.scene.materials[static_cast<std::size_t>(floor)].inputs[0].texture = board;
  s.scene.materials[static_cast<std::size_t>(ball)].name = "lacquer";
  pictures::set_input(s.scene, ball, "kd", {0.1f, 0.2f, 0.3f});
  pictures::add_object(s.scene, pictures::quad({0, 0, 0.25f}, {2, 0, 0}, {0, 2, 0}), floor);
  pictures::add_object(s.scene, pictures::sphere({0, 0, 0.5f}, 0.3f, 4, true), ball, 3);
  s.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  s.scene.lights.back().name = "sky";
  s.scene.lights.push_back(pictures::point_light({0, 0, 2}, {1, 1, 1}));
  s.scene.lights.back().name = "bulb";
  s.camera.lens_radius_m = 0.01;
  return s;
}

std::set<std::string> names(const std::vector<Choice>& choices, const std::string& group) {
  std::set<std::string> found;
  for (const Choice& choice : choices)
    if (choice.group == group) found.insert(choice.name);
  return found;
}

Subject with(const std::string& name) {
  Subject s = subject();
  for (const Choice& choice : choices_for(s))
    if (choice.name == name) {
      choice.apply(s);
      return s;
    }
  ADD_FAILURE() << "there is no choice " << name;
  return s;
}

TEST(Choices, AreWhatTheSceneHas) {
  const std::vector<Choice> choices = choices_for(subject());
  EXPECT_THAT(names(choices, k_effect_group),
              testing::UnorderedElementsAre("lens", "light sky", "light bulb", "texture board",
                                            "glossy2 of lacquer", "smooth normals"));
  EXPECT_THAT(names(choices, k_depth_group),
              testing::UnorderedElementsAre("2", "3", "4", "6", "8", "12", "16"));
  EXPECT_THAT(names(choices, k_math_group), testing::UnorderedElementsAre("fast"));
  EXPECT_THAT(names(choices, k_texture_filter_group), testing::IsEmpty());
  EXPECT_THAT(names(choices, k_filter_group), Not(Contains("3 px")));  // the subject's own
  Subject pinhole = subject();
  pinhole.camera.lens_radius_m = 0;
  EXPECT_THAT(names(choices_for(pinhole), k_effect_group), Not(Contains("lens")));
}

TEST(Choices, EachOfThemDoesWhatItSays) {
  EXPECT_EQ(with("fast").engine.math, MathMode::fast);
  const Subject deep = with("12");
  EXPECT_EQ(deep.engine.depth_total, 12);
  EXPECT_EQ(deep.engine.depth_diffuse, 12);
  EXPECT_EQ(with("box of 1 px").engine.filter_width, 0);
  EXPECT_EQ(with("lens").camera.lens_radius_m, 0);
  const Subject dark = with("light sky");
  EXPECT_FALSE(shines(dark.scene.lights[0]));
  EXPECT_TRUE(shines(dark.scene.lights[1]));
  for (const Object& object : with("smooth normals").scene.objects)
    EXPECT_TRUE(object.mesh.normals.empty());
  const Subject plain = with("texture board");
  EXPECT_EQ(plain.scene.materials[0].inputs[0].texture, -1);
  EXPECT_NEAR(double{plain.scene.materials[0].inputs[0].constant.x}, 0.5, 0.02);
}

TEST(Choices, ACoatIsTakenOffItsBase) {
  const Subject bare = with("glossy2 of lacquer");
  const Material& material = bare.scene.materials[1];
  EXPECT_EQ(material_types()[static_cast<std::size_t>(material.type)].name, "matte");
  const int kd = find_input(material_types()[static_cast<std::size_t>(material.type)], "kd");
  EXPECT_EQ(material.inputs[static_cast<std::size_t>(kd)].constant, (Vec3{0.1f, 0.2f, 0.3f}));
}

/// "sort name" of those effects that are simulated.
std::set<std::string> simulated(const Subject& s) {
  std::set<std::string> found;
  for (const Effect& effect : effects_of(s.scene, s.camera))
    if (effect.simulated) found.insert(effect.sort + " " + effect.name);
  return found;
}

TEST(EffectChoices, LeaveOutEveryEffectOfTheTablesOrSayWhyNot) {
  std::set<std::string> seen;
  for (const pictures::Picture& picture : pictures::all_effects()) {
    const Subject whole{picture.scene, picture.camera, picture.engine};
    const std::set<std::string> effects = simulated(whole);
    seen.insert(effects.begin(), effects.end());
    std::set<std::string> left_out;
    const EffectChoices found = effect_choices(whole);
    for (const Choice& choice : found.choices) {
      Subject other = whole;
      choice.apply(other);
      const std::set<std::string> rest = simulated(other);
      std::set_difference(effects.begin(), effects.end(), rest.begin(), rest.end(),
                          std::inserter(left_out, left_out.end()));
      EXPECT_TRUE(
          std::any_of(rest.begin(), rest.end(),
                      [](const std::string& effect) { return effect.starts_with("light "); }))
          << choice.name << " leaves " << picture.name << " dark";
    }
    std::set<std::string> kept;
    for (const KeptEffect& effect : found.kept) {
      EXPECT_FALSE(effect.why.empty());
      kept.insert(effect.effect.sort + " " + effect.effect.name);
    }
    for (const std::string& effect : effects)
      EXPECT_EQ(left_out.count(effect) + kept.count(effect), 1U) << effect << ", " << picture.name;
    // The first picture has no light that is not sampled; of a picture's only light nothing is left out.
    std::set<std::string> expected{"material matte"};
    const bool one_light = picture.name.starts_with("light-");
    if (one_light) expected = {"light " + picture.name.substr(6)};
    if (picture.name == "materials" || one_light) expected.insert("transport sampling of lights");
    EXPECT_EQ(kept, expected) << picture.name;
  }
  // The pictures have every effect there is.
  EXPECT_EQ(seen.size(), effects_of({}, {}).size());
}

TEST(EffectChoices, TheOnlyLightStays) {
  Subject s = subject();
  s.scene.lights.pop_back();
  const EffectChoices found = effect_choices(s);
  EXPECT_THAT(names(found.choices, k_effect_group), Not(Contains("light sky")));
  const auto sky = std::find_if(found.kept.begin(), found.kept.end(), [](const KeptEffect& kept) {
    return kept.effect.name == "constant_infinite";
  });
  ASSERT_NE(sky, found.kept.end());
  EXPECT_EQ(sky->why, "without it the scene is dark");
}

TEST(EffectChoices, SeveralOfAKindAreLeftOutTogetherToo) {
  Subject s = subject();
  s.scene.lights.push_back(pictures::point_light({1, 0, 2}, {1, 1, 1}));
  s.scene.lights.back().name = "lamp";
  EXPECT_THAT(names(effect_choices(s).choices, k_effect_group),
              testing::IsSupersetOf({"light bulb", "light lamp", "point lights"}));
}

TEST(EffectChoices, ATextureOfSeveralMaterialsGoesWhateverElseIsLeftOut) {
  Subject s = subject();
  const int other = pictures::add_texture(s.scene, "checkerboard3d", {});
  s.scene.textures[static_cast<std::size_t>(other)].name = "other";
  s.scene.materials[1].inputs[0].texture = other;  // the kd of a material that goes too
  const EffectChoices found = effect_choices(s);
  EXPECT_THAT(names(found.choices, k_effect_group), Contains("checkerboard3d textures"));
  for (const KeptEffect& kept : found.kept)
    EXPECT_NE(kept.effect.sort, "texture") << kept.why;
}

TEST(MaterialAlbedo, IsWhatComesBack) {
  for (const NodeType& type : material_types()) {
    if (type.name == "mix") continue;
    Scene scene;
    const int i = pictures::add_material(scene, type.name);
    const Vec3 albedo = material_albedo(scene.materials[static_cast<std::size_t>(i)]);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(albedo[axis], 0.01f) << type.name;
      EXPECT_LE(albedo[axis], 1) << type.name;
    }
  }
  Scene scene;
  const int matte = pictures::add_matte(scene, {0.2f, 0.4f, 0.6f});
  EXPECT_NEAR(double{material_albedo(scene.materials[static_cast<std::size_t>(matte)]).y}, 0.4,
              1e-5);
  const int mirror = pictures::add_material(scene, "mirror");
  pictures::set_input(scene, mirror, "kr", {0.9f, 0.8f, 0.7f});
  EXPECT_NEAR(double{material_albedo(scene.materials[static_cast<std::size_t>(mirror)]).z}, 0.7,
              1e-5);
  // Nothing is lost in glass.
  const int glass = pictures::add_material(scene, "glass");
  EXPECT_NEAR(double{material_albedo(scene.materials[static_cast<std::size_t>(glass)]).x}, 1, 1e-4);
  // Aluminium of assets/materials: 0.913 in green at normal incidence, 0.90 to 0.93 over all.
  const int metal = pictures::add_material(scene, "metal2");
  pictures::set_input(scene, metal, "n", {1.373f, 0.890f, 0.651f});
  pictures::set_input(scene, metal, "k", {7.618f, 6.468f, 5.665f});
  EXPECT_NEAR(double{material_albedo(scene.materials[static_cast<std::size_t>(metal)]).y}, 0.915,
              0.02);
}

TEST(TextureMean, OfAnImageIsThatOfItsTexels) {
  Scene scene;
  Image image;
  image.width = image.height = 2;
  image.filter = ImageFilter::nearest;
  image.rgb = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
  scene.images.push_back(image);
  const int texture = pictures::add_texture(scene, "imagemap", {});
  scene.textures[0].image = 0;
  const int material = pictures::add_matte(scene, {});
  scene.materials[0].inputs[0].texture = texture;
  EXPECT_FALSE(texture_mean(scene, texture, 16).has_value()) << "no object shows it";
  pictures::add_object(scene, pictures::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), material);
  const Vec3 mean = texture_mean(scene, texture, 20000).value();
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(double{mean[axis]}, 0.5, 0.01);
}

}  // namespace
}  // namespace ds
