// SPDX-License-Identifier: Apache-2.0
#include "builder/report/choices.h"
#include "builder/report/texture_mean.h"
#include "tests/render/pictures.h"
#include "tracer/scene/type_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
                                            "coat of lacquer", "smooth normals"));
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
  ASSERT_EQ(dark.scene.lights.size(), 1U);
  EXPECT_EQ(dark.scene.lights[0].name, "bulb");
  for (const Object& object : with("smooth normals").scene.objects)
    EXPECT_TRUE(object.mesh.normals.empty());
  const Subject plain = with("texture board");
  EXPECT_EQ(plain.scene.materials[0].inputs[0].texture, -1);
  EXPECT_NEAR(double{plain.scene.materials[0].inputs[0].constant.x}, 0.5, 0.02);
}

TEST(Choices, ACoatIsTakenOffItsBase) {
  const Subject bare = with("coat of lacquer");
  const Material& material = bare.scene.materials[1];
  EXPECT_EQ(material_types()[static_cast<std::size_t>(material.type)].name, "matte");
  const int kd = find_input(material_types()[static_cast<std::size_t>(material.type)], "kd");
  EXPECT_EQ(material.inputs[static_cast<std::size_t>(kd)].constant, (Vec3{0.1f, 0.2f, 0.3f}));
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
