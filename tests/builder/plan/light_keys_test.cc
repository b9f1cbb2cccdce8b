// SPDX-License-Identifier: Apache-2.0
// What the lights of a recipe make stale, and what they leave alone.
#include "tests/builder/tiny_dataset.h"
#include "tracer/scene/told_lights.h"
#include "tracer/scene/type_tables.h"

#include <gmock/gmock.h>

#include <set>
#include <string>
#include <vector>

namespace ds {
namespace {

class LightKeys : public TinyDataset {
 protected:
  static constexpr const char* k_planes =
      "outputs.planes=[\"mask\",\"object_id\",\"albedo\",\"direct_diffuse\"]";

  Plan plan_with(const std::string& lights, std::vector<std::string> more = {}) {
    request.overrides = {k_planes, "lights=[" + lights + "]"};
    request.overrides.insert(request.overrides.end(), more.begin(), more.end());
    Plan made = plan();
    for (const PlannedImage& image : made.images)
      EXPECT_FALSE(image.error) << image.error->what();
    return made;
  }
  /// Kinds of files whose keys differ in some image.
  static std::set<std::string> moved(const Plan& a, const Plan& b) {
    std::set<std::string> kinds;
    for (std::size_t i = 0; i < a.images.size(); ++i)
      for (std::size_t o = 0; o < a.images[i].keys.outputs.size(); ++o)
        if (a.images[i].keys.outputs[o].key != b.images[i].keys.outputs[o].key)
          kinds.insert(a.images[i].keys.outputs[o].kind);
    return kinds;
  }
  static void expect_same(const Plan& a, const Plan& b) {
    ASSERT_EQ(a.images.size(), b.images.size());
    for (std::size_t i = 0; i < a.images.size(); ++i) {
      EXPECT_EQ(a.images[i].keys.parts, b.images[i].keys.parts);
      EXPECT_EQ(a.images[i].keys.render, b.images[i].keys.render);
      EXPECT_EQ(a.images[i].keys.files, b.images[i].keys.files);
    }
  }
};

const std::set<std::string> k_lit{"image", "direct_diffuse"};

TEST_F(LightKeys, NoneAreAsIfTheRecipeDidNotKnowThem) {
  request.overrides = {k_planes};
  const Plan without = plan();
  expect_same(without, plan_with(""));
  expect_same(without, plan_with("{type=\"point\",position_m=[0,0,1],count=0}"));
  EXPECT_EQ(moved(without, plan_with("{type=\"point\",position_m=[0,0,1]}")), k_lit);
}

TEST_F(LightKeys, AreOfThePictureAndOfLightAlone) {
  const Plan before = plan_with("{type=\"point\",position_m=[0,0,1],gain=2}");
  for (const char* other :
       {"{type=\"point\",position_m=[0,0,1],gain=3}",
        "{type=\"point\",position_m=[0,0,1.5],gain=2}",
        "{type=\"point\",position_m=[0,0,1],gain=2,color=[1,0,0]}",
        "{type=\"point\",position_m=[0,0,1],gain=2,temperature_k=3000}",
        "{type=\"point\",position_m=[0,0,1],gain=2,count=2}",
        "{type=\"spot\",position_m=[0,0,1],gain=2}",
        "{type=\"point\",position_m=[0,0,1],gain={uniform=[1,3]}}",
        "{type=\"point\",position_m=[0,0,1],gain=2},{type=\"distant\",from=[1,0,1]}"})
    EXPECT_EQ(moved(before, plan_with(other)), k_lit) << other;
  // The same light by other words.
  for (const char* same :
       {"{type=\"point\",position_m={choice=[[0,0,1]]},gain={uniform=[2,2]}}",
        "{type=\"point\",position_m=[0,0,1],gain=2,temperature_k=false,color=[1,1,1],count=1}"})
    expect_same(before, plan_with(same));
  // Its own things stay what they were: of the five parts the camera's has it, and the program what kind it is.
  const Plan brighter = plan_with("{type=\"point\",position_m=[0,0,1],gain=3}");
  for (std::size_t i = 0; i < before.images.size(); ++i)
    for (std::size_t part = 0; part < 6; ++part)
      EXPECT_EQ(before.images[i].keys.parts[part] == brighter.images[i].keys.parts[part], part != 3)
          << part;
}

TEST_F(LightKeys, AProgramHasTheKindsThatAnImageShows) {
  const auto engine = [](const Plan& plan, std::size_t i) { return plan.images[i].keys.parts[4]; };
  request.overrides = {k_planes};
  const Plan without = plan();
  const Plan dark = plan_with("{type=\"point\",position_m=[0,0,1],gain=0}");
  const Plan lit = plan_with("{type=\"point\",position_m=[0,0,1]}");
  const Plan two = plan_with("{type=\"point\",position_m=[0,0,1],count=2}");
  const Plan drawn = plan_with("{type=\"point\",position_m=[0,0,1],count={integer=[0,1]}}");
  std::set<std::size_t> shown;
  for (std::size_t i = 0; i < lit.images.size(); ++i) {
    // One that is dark is as if it were not there.
    EXPECT_EQ(engine(without, i), engine(dark, i));
    EXPECT_NE(engine(without, i), engine(lit, i));
    EXPECT_EQ(engine(two, i), engine(lit, i));
    const std::size_t count = drawn.images[i].spec.lights->size();
    EXPECT_EQ(engine(drawn, i), engine(count == 0 ? without : lit, i));
    shown.insert(count);
  }
  EXPECT_EQ(shown, (std::set<std::size_t>{0, 1}));
}

TEST_F(LightKeys, WhatIsOfThemIsSaidOfThem) {
  const std::string mask = "outputs.planes=[\"mask\"]";
  plan_with("{type=\"point\",position_m=[0,0,1]}", {mask});
  build();
  EXPECT_TRUE(stale().empty());
  const Plan after = plan_with("{type=\"point\",position_m=[0,0,1.5]}", {mask});
  for (const PlannedImage& image : after.images)
    EXPECT_THAT(image.reasons,
                testing::ElementsAre("lights changed: lights[0].position: 0 0 1 -> 0 0 1.5"));
}

TEST_F(LightKeys, KeepTheClearanceThatIsAskedOfCameras) {
  const std::string lamp = "{type=\"point\",position_m={box=[[-0.1,-0.1,-0.05],[0.1,0.1,0.2]]}}";
  const Plan anywhere = plan_with(lamp);
  const Plan clear = plan_with(lamp, {"camera.keep.clearance_m=0.04"});
  std::size_t moved_lights = 0;
  for (std::size_t i = 0; i < clear.images.size(); ++i) {
    const Vec3 before = light_vector((*anywhere.images[i].spec.lights)[0], "position"),
               after = light_vector((*clear.images[i].spec.lights)[0], "position");
    moved_lights += before == after ? 0U : 1U;
    EXPECT_EQ(before == after, clear.images[i].spec.variables->attempts == 0);
    // The box is the larger model: a cube's corner is 0.14 from its middle at most, its face 0.02 at least.
    EXPECT_GT(length(to_double(after)), 0.02 + 0.04) << clear.images[i].spec.id;
  }
  EXPECT_GT(moved_lights, 0U);
}

}  // namespace
}  // namespace ds
