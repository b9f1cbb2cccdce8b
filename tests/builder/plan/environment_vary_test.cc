// SPDX-License-Identifier: Apache-2.0
// What is drawn of environments' lights and materials: what it makes stale, and what it leaves alone.
#include "builder/plan/dataset_manifest.h"
#include "tests/builder/tiny_dataset.h"

#include <gmock/gmock.h>

#include <set>
#include <string>
#include <vector>

namespace ds {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class EnvironmentVary : public TinyDataset {
 protected:
  static constexpr const char* k_planes =
      "outputs.planes=[\"mask\",\"object_id\",\"albedo\",\"direct_diffuse\"]";

  Plan plan_with(const std::string& vary, std::vector<std::string> more = {}) {
    request.overrides = {k_planes, "environments.vary={" + vary + "}"};
    request.overrides.insert(request.overrides.end(), more.begin(), more.end());
    Plan made = plan();
    for (const PlannedImage& image : made.images)
      EXPECT_FALSE(image.error) << image.error->what();
    return made;
  }
  std::string message(const std::string& vary) {
    request.overrides = {"environments.vary={" + vary + "}"};
    try {
      plan();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::recipe);
      return error.what();
    }
    return "";
  }
  /// "floor: image albedo": kinds of files whose keys differ in some image, by environment.
  static std::set<std::string> moved(const Plan& a, const Plan& b) {
    std::set<std::string> kinds;
    for (std::size_t i = 0; i < a.images.size(); ++i)
      for (std::size_t o = 0; o < a.images[i].keys.outputs.size(); ++o)
        if (a.images[i].keys.outputs[o].key != b.images[i].keys.outputs[o].key)
          kinds.insert(*a.images[i].spec.environment_name + " " + a.images[i].keys.outputs[o].kind);
    return kinds;
  }
  static void expect_same(const Plan& a, const Plan& b) {
    ASSERT_EQ(a.images.size(), b.images.size());
    for (std::size_t i = 0; i < a.images.size(); ++i) {
      EXPECT_EQ(a.images[i].keys.parts, b.images[i].keys.parts) << a.images[i].spec.id;
      EXPECT_EQ(a.images[i].keys.files, b.images[i].keys.files) << a.images[i].spec.id;
    }
  }
};

TEST_F(EnvironmentVary, ValuesThatTheFileHasAreNoChange) {
  const Plan without = plan_with("");
  request.overrides = {k_planes};
  expect_same(plan(), without);
  expect_same(plan_with("\"floor/floor.kd\"=0.5,\"floor/sky.color\"={choice=[[1,1,1]]},"
                        "\"plain/sky.color\"={cycle=[[0.8,0.9,1]]},\"sky.gain\"={uniform=[1,1]}"),
              without);
  // The later one counts: of another image of the file's value nothing is left.
  expect_same(plan_with("\"floor/f*.kd\"=0.3,\"floor/floor.kd\"=0.5"), without);
  EXPECT_FALSE(moved(without, plan_with("\"floor/floor.kd\"=0.3")).empty());
}

// Of one environment no image of another one changes; lights move no plane that asks for none.
TEST_F(EnvironmentVary, MovesWhatShowsIt) {
  const Plan without = plan_with("");
  const std::set<std::string> lit{"floor image", "floor direct_diffuse"};
  EXPECT_EQ(moved(without, plan_with("\"floor/sky.gain\"={uniform=[2,3]}")), lit);
  EXPECT_EQ(moved(without, plan_with("\"floor/floor.emission\"=0.5")), lit);
  std::set<std::string> coloured = lit;
  coloured.insert("floor albedo");
  EXPECT_EQ(moved(without, plan_with("\"floor.kd?\"={uniform=[0.1,0.4]}")), coloured);
  const Plan all = plan_with("\"sky.color\"={hsv=[[0,1],[0.1,0.3],[0.7,0.9]]}");
  EXPECT_EQ(moved(without, all), (std::set<std::string>{"floor image", "floor direct_diffuse",
                                                        "plain image", "plain direct_diffuse"}));
  std::set<Hash128> views;
  for (std::size_t i = 0; i < all.images.size(); ++i) {
    const PartHashes &a = without.images[i].keys.parts, &b = all.images[i].keys.parts;
    views.insert(b[3]);
    for (std::size_t part = 0; part < 5; ++part)
      EXPECT_EQ(a[part] == b[part], part != 3) << k_part_names[part];
  }
  EXPECT_EQ(views.size(), k_images);  // each draws its own
}

TEST_F(EnvironmentVary, OnlyValuesCount) {
  const Plan constant = plan_with("\"floor/sky.gain\"=2");
  expect_same(plan_with("\"floor/sky.gain\"={uniform=[2,2]}"), constant);
  expect_same(plan_with("\"floor/s*.gain\"={choice=[[2,2,2]],per=\"model\"}"), constant);
  expect_same(plan_with("\"*/sky.gain\"=2,\"plain/sky.gain\"=1"), constant);
  EXPECT_FALSE(moved(constant, plan_with("\"floor/sky.gain\"={uniform=[2,3]}")).empty());
}

// The program is that of a file that has the values: of a light that is dark there is nothing in it, nor of a
// texture that a number stands for.
TEST_F(EnvironmentVary, ProgramsAreThoseOfSuchAFile) {
  const auto engines = [](const Plan& plan) {
    std::vector<Hash128> parts;
    for (const PlannedImage& image : plan.images)
      parts.push_back(image.keys.parts[4]);
    return parts;
  };
  const Plan lit = plan_with("\"floor/sky.color\"=0.5");
  const Plan dark = plan_with("\"floor/sky.color\"=0");
  EXPECT_EQ(engines(plan_with("")), engines(lit));
  EXPECT_NE(engines(lit), engines(dark));
  const std::string scene = "environments/floor/environment.scn";
  edit(scene, "sky.color = 1.0 1.0 1.0", "sky.color = 0 0 0");
  EXPECT_EQ(engines(plan_with("")), engines(dark));
  edit(scene, "sky.color = 0 0 0", "sky.color = 1.0 1.0 1.0");
  edit(scene, "scene.materials.floor.kd = 0.5 0.5 0.5",
       "scene.textures.net.type = checkerboard3d\nscene.textures.net.mapping.type = "
       "globalmapping3d\n"
       "scene.materials.floor.kd = net\nscene.materials.floor.type = matte");
  EXPECT_NE(engines(plan_with("")), engines(lit));
  EXPECT_EQ(engines(plan_with("\"floor/floor.kd\"={uniform=[0.2,0.4]}")), engines(lit));
  // Drawn within the texture, it stays one.
  EXPECT_EQ(engines(plan_with("\"floor/net.texture1\"={uniform=[0.2,0.4]}")),
            engines(plan_with("")));
  EXPECT_EQ(moved(plan_with(""), plan_with("\"floor/net.texture1\"=0.25")),
            (std::set<std::string>{"floor image", "floor albedo", "floor direct_diffuse"}));
}

TEST_F(EnvironmentVary, AModelOrADistributionMoreMovesNoOther) {
  const std::string vary = "\"floor/sky.gain\"={uniform=[2,3]}";
  const Plan before = plan_with(vary);
  const Plan more =
      plan_with(vary + ",\"floor/floor.emission?\"={choice=[0]},\"plain/sky.gain\"=4");
  for (std::size_t i = 0; i < before.images.size(); ++i)
    if (*before.images[i].spec.environment_name == "floor") {
      EXPECT_EQ(before.images[i].keys.render, more.images[i].keys.render);
    }
  std::filesystem::copy_file(recipe_folder() / "models/box.off", recipe_folder() / "models/a.off");
  const Plan with_model = plan_with(vary);
  ASSERT_EQ(with_model.images.size(), before.images.size() + 4);
  for (const PlannedImage& image : before.images)
    for (const PlannedImage& now : with_model.images)
      if (now.spec.id == image.spec.id) {
        EXPECT_EQ(now.keys.render, image.keys.render);
        EXPECT_EQ(now.spec.variables->draws, image.spec.variables->draws);
      }
}

TEST_F(EnvironmentVary, WhatWasDrawnIsTold) {
  request.overrides = {"environments.vary={\"floor/sky.gain\"={uniform=[2,3]}}"};
  build();
  const DatasetRecord dataset = read_dataset_manifest(output());
  const DrawSummary& gain = dataset.draws.at("environments.vary.floor/sky.gain");
  EXPECT_EQ(gain.distribution, "{uniform = [2.0, 3.0]}");
  EXPECT_EQ(gain.count, k_images);
  EXPECT_TRUE(stale().empty());
  request.overrides = {"environments.vary={\"floor/sky.gain\"=4}"};
  for (const PlannedImage& image : plan().images)
    if (*image.spec.environment_name == "floor")
      EXPECT_THAT(image.reasons, ::testing::Contains(::testing::StartsWith(
                                     "environment changed: vary.lights.sky.gain: ")));
    else
      EXPECT_FALSE(image.stale()) << image.spec.id;
}

TEST_F(EnvironmentVary, ErrorsSayWhatIsWantedAndWhatThereIs) {
  EXPECT_THAT(
      message("\"flor/sky.gain\"=2"),
      AllOf(
          HasSubstr("--set environments.vary"),
          HasSubstr("\"flor/sky.gain\" names no environment of the recipe, did you mean floor?")));
  EXPECT_THAT(message("\"floor/sky.gian\"=2"),
              HasSubstr("found none in floor, did you mean sky.gain?"));
  EXPECT_THAT(
      message("\"floor.kd\"=0.2"),
      HasSubstr("found none in plain; with a ? behind it such an environment is left as it is"));
  EXPECT_THAT(message("\"nothing.kd?\"=0.2"), HasSubstr("names no property of any environment"));
  EXPECT_THAT(message("\"floor/floor.kd\"={uniform=[0,2]}"),
              HasSubstr("(floor's materials.floor.kd) {uniform} must give numbers in [0, 1], got"));
  EXPECT_THAT(message("\"floor/sky.gain\"={uniform=[-1,2]}"),
              HasSubstr("(floor's lights.sky.gain)"));
  EXPECT_THAT(message("\"floor/sky.color\"={ball=1}"),
              HasSubstr("{ball} gives another kind of value"));
  EXPECT_THAT(message("\"floor/sky.temperature\"=[1,2,3]"),
              HasSubstr("is one number in floor's lights.sky.temperature, and three are drawn"));
  EXPECT_THAT(message("\"floor/floor.id\"=2"),
              HasSubstr("names floor's materials.floor.id, which is no number to be drawn"));
  EXPECT_THAT(message("\"kd\"=0.1"),
              HasSubstr("must be NAME.PROPERTY or ENVIRONMENT/NAME.PROPERTY"));
  EXPECT_THAT(message("\"sky.gain\"={unifrom=[0,1]}"), HasSubstr("did you mean uniform?"));
  EXPECT_EQ(message("\"floor/sky.gain\"=2"), "");
  edit("recipe.toml", "[camera]", "vary = { \"floor/sky.gian\" = 2 }\n\n[camera]");
  EXPECT_THAT(message(""), "");
  request.overrides.clear();
  EXPECT_THROW(
      {
        try {
          plan();
        } catch (const Error& error) {
          EXPECT_THAT(error.what(),
                      HasSubstr("recipe.toml:18:29: environments.vary \"floor/sky.gian\""));
          throw;
        }
      },
      Error);
}

}  // namespace
}  // namespace ds
