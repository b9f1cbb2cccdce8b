// SPDX-License-Identifier: Apache-2.0
// What distributions make stale, and what the manifest says of them.
#include "builder/plan/dataset_manifest.h"
#include "tests/builder/tiny_dataset.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace ds {
namespace {

class DrawsTest : public TinyDataset {
 protected:
  std::map<std::string, Hash128> render_keys(std::vector<std::string> overrides) {
    request.overrides = std::move(overrides);
    std::map<std::string, Hash128> keys;
    for (const PlannedImage& image : plan().images) {
      EXPECT_FALSE(image.error) << image.error->what();
      keys[image.spec.id] = image.keys.render;
    }
    return keys;
  }
};

const char* const k_drawn_keys[] = {
    "camera.fov_deg",       "camera.distance_m",     "camera.roll_deg",  "camera.azimuth_deg",
    "camera.elevation_deg", "environments.turn_deg", "environments.gain"};

// What moves the model is of its part, so that masks follow; colour is the picture's alone.
TEST_F(DrawsTest, WhatIsDrawnOfModelsAndLightIsInTheirParts) {
  const Plan before = plan();
  const auto compare = [&](const std::string& setting, std::size_t part, bool masks) {
    request.overrides = {setting};
    const Plan after = plan();
    for (std::size_t i = 0; i < after.images.size(); ++i) {
      const ImageKeys &a = before.images[i].keys, &b = after.images[i].keys;
      EXPECT_NE(a.render, b.render) << setting;
      EXPECT_NE(a.parts[part], b.parts[part]) << setting;
      for (std::size_t other = 0; other < 5; ++other)
        if (other != part) {
          EXPECT_EQ(a.parts[other], b.parts[other]) << setting << other;
        }
      for (std::size_t o = 0; o < a.outputs.size(); ++o)
        if (a.outputs[o].plane != nullptr) {
          EXPECT_EQ(a.outputs[o].key != b.outputs[o].key, masks) << setting;
        }
    }
  };
  compare("models.turn={rotation=\"up\"}", 0, true);
  compare("models.turn={rotation=\"any\"}", 0, true);
  compare("models.turn=[1,0,0,1]", 0, true);
  compare("models.place_m={disc=[0.01,0.05]}", 0, true);
  compare("models.size_m={log_uniform=[0.1,0.15]}", 0, true);
  compare("environments.temperature_k={uniform=[3000,8000]}", 3, false);
}

TEST_F(DrawsTest, ATurnOfNothingAndAPlaceOfNothingAreNone) {
  const auto none = render_keys({});
  for (const char* key :
       {"models.turn=[0.5,0,0,0]", "models.turn={choice=[[1,0,0,0]]}", "models.place_m={disc=0}",
        "models.turn=\"none\"", "models.size_m={uniform=[0.16,0.16]}",
        "environments.temperature_k=false"})
    EXPECT_EQ(render_keys({key}), none) << key;
  EXPECT_EQ(render_keys({"models.turn=[0.3,0,0,-0.4]"}),
            render_keys({"models.turn={choice=[[0.6,0,0,-0.8]]}"}));
}

// A size is a thing's, a turn an image's, unless the recipe says otherwise.
TEST_F(DrawsTest, AKeySaysForWhatItIsDrawn) {
  request.overrides = {"models.size_m={uniform=[0.1,0.2]}", "models.turn={rotation=\"up\"}"};
  std::map<std::string, std::set<double>> sizes, turns;
  for (const PlannedImage& image : plan().images) {
    const Variables& values = image.spec.variables->values;
    sizes[*image.spec.model_name].insert(values.model_size_m);
    turns[*image.spec.model_name].insert(values.model_turn[0]);
  }
  for (const auto& [model, values] : sizes)
    EXPECT_EQ(values.size(), 1U) << model;
  for (const auto& [model, values] : turns)
    EXPECT_GT(values.size(), 1U) << model;
  request.overrides = {"models.size_m={uniform=[0.1,0.2],per=\"view\"}"};
  std::set<double> all;
  for (const PlannedImage& image : plan().images)
    all.insert(image.spec.variables->values.model_size_m);
  EXPECT_GT(all.size(), sizes.size());
}

// Only the value counts, not what it was drawn from.
TEST_F(DrawsTest, ADistributionOfOneValueHasThatValuesKeys) {
  const auto none = render_keys({});
  for (const std::string key : k_drawn_keys) {
    const auto constant = render_keys({key + "=2"});
    EXPECT_NE(constant, none) << key;
    EXPECT_EQ(render_keys({key + "={uniform=[2,2]}"}), constant) << key;
    EXPECT_EQ(render_keys({key + "={choice=[2],per=\"model\"}"}), constant) << key;
    EXPECT_NE(render_keys({key + "={uniform=[2,3]}"}), constant) << key;
  }
  EXPECT_EQ(render_keys({"environments.turn_deg={uniform=[0,0]}", "environments.gain={cycle=[1]}"}),
            none);
}

TEST_F(DrawsTest, AnotherDistributionWithTheSameValuesMakesNothingStale) {
  request.overrides = {"environments.gain={choice=[1,2]}"};
  build();
  EXPECT_TRUE(stale().empty());
  request.overrides = {"environments.gain={choice=[2,1],weights=[3,3]}"};
  const Plan after = plan();
  for (const PlannedImage& image : after.images)
    EXPECT_FALSE(image.stale()) << image.spec.id;
  EXPECT_THAT(after.manifest.behind, testing::ElementsAre("settings: environments.gain"));
  // A value that is likelier now takes images over, and the others stay.
  request.overrides = {"environments.gain={choice=[1,2],weights=[1,9]}"};
  for (const PlannedImage& image : plan().images)
    if (image.stale()) {
      EXPECT_THAT(image.reasons, testing::ElementsAre("environment changed: gain: added 2"));
      EXPECT_EQ(image.spec.variables->values.environment_gain, 2);
    }
}

TEST_F(DrawsTest, TheManifestSaysWhatWasDrawn) {
  request.overrides = {"camera.fov_deg={uniform=[40,60]}", "camera.target={ball=0.01}"};
  build();
  const DatasetRecord dataset = read_dataset_manifest(output());
  ASSERT_EQ(dataset.draws.size(), 2U);
  const DrawSummary& fov = dataset.draws.at("camera.fov_deg");
  EXPECT_EQ(fov.distribution, "{uniform = [40.0, 60.0]}");
  EXPECT_EQ(fov.count, k_images);
  double sum = 0, least = 180, most = 0;
  for (const ImageRecord& image : read_images_manifest(output())) {
    ASSERT_EQ(image.draws.size(), 2U);
    EXPECT_EQ(image.draws.at("camera.target").values.size(), 3U);
    const double value = image.draws.at("camera.fov_deg").values.at(0);
    EXPECT_EQ(image.intrinsics, camera_intrinsics(value, 32, 32));
    sum += value;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  EXPECT_EQ(fov.least, std::vector{least});
  EXPECT_EQ(fov.most, std::vector{most});
  EXPECT_NEAR(fov.mean.at(0), sum / k_images, 1e-13);
  EXPECT_EQ(build().built, 0U);
}

// A constant that becomes a distribution of it: no picture, but a line that says so.
TEST_F(DrawsTest, LinesFollowTheRecipesDistributions) {
  request.overrides = {"camera.fov_deg=50"};
  build();
  EXPECT_TRUE(read_images_manifest(output())[0].draws.empty());
  request.overrides = {"camera.fov_deg={uniform=[50,50]}"};
  build();
  EXPECT_TRUE(calls.traced.empty());
  EXPECT_EQ(read_images_manifest(output())[0].draws.at("camera.fov_deg").values, std::vector{50.0});
  request.overrides = {"camera.fov_deg=50"};
  build();
  EXPECT_TRUE(read_images_manifest(output())[0].draws.empty());
}

TEST_F(DrawsTest, ACameraThatSeesNothingIsAnErrorOfItsImageAlone) {
  request.overrides = {"camera.set=\"random\"", "camera.count=8",
                       "camera.position_m={choice=[[0,0,0],[0.4,0,0.1]]}"};
  std::size_t failed = 0, made = 0;
  for (const PlannedImage& image : plan().images) {
    ++(image.error ? failed : made);
    if (image.error) {
      EXPECT_EQ(std::string(image.error->what()),
                image.spec.id + ": camera.target must not be where a camera stands, got view " +
                    *image.spec.view + " there");
    }
  }
  EXPECT_GT(failed, 0U);
  EXPECT_GT(made, 0U);
}

// Effects of the camera change what is made of films, and no film.
TEST_F(DrawsTest, EffectsOfTheCameraTraceNothing) {
  build();
  request.overrides = {"outputs.camera.noise={uniform=[0.01,0.02]}",
                       "outputs.camera.jpeg_quality={integer=[60,95]}"};
  const Plan after = plan();
  for (const PlannedImage& image : after.images) {
    EXPECT_THAT(image.reasons,
                testing::Contains(testing::StartsWith("files changed: camera.noise: added 0.01")));
    EXPECT_FALSE(image.trace_film || image.trace_planes) << image.spec.id;
  }
  build();
  EXPECT_TRUE(calls.traced.empty());
  EXPECT_TRUE(calls.planes.empty());
  for (const ImageRecord& image : read_images_manifest(output()))
    EXPECT_TRUE(image.draws.at("outputs.camera.jpeg_quality").whole);
  const auto noisy = contents();
  request.overrides = {"outputs.camera.noise={cycle=[0]}"};
  build();
  EXPECT_TRUE(calls.traced.empty());
  for (const auto& [path, bytes] : contents())
    if (path.ends_with("0.png")) {
      EXPECT_NE(bytes, noisy.at(path)) << path;
    }
}

// What is drawn of a material is of its part; another material's image is another's business.
TEST_F(DrawsTest, PropertiesOfMaterialsAreDrawn) {
  const Plan before = plan();
  request.overrides = {"materials.vary={\"*.kd\"={hsv=[[0,1],[0.5,0.9],[0.3,0.9]]}}"};
  const Plan after = plan();
  std::set<Hash128> materials;
  for (std::size_t i = 0; i < after.images.size(); ++i) {
    const ImageKeys &a = before.images[i].keys, &b = after.images[i].keys;
    ASSERT_FALSE(after.images[i].error) << after.images[i].error->what();
    EXPECT_NE(a.parts[1], b.parts[1]);
    for (std::size_t other = 0; other < 5; ++other)
      if (other != 1) {
        EXPECT_EQ(a.parts[other], b.parts[other]) << other;
      }
    for (std::size_t o = 0; o < a.outputs.size(); ++o)
      if (a.outputs[o].plane != nullptr) {
        EXPECT_EQ(a.outputs[o].key, b.outputs[o].key);
      }
    materials.insert(b.parts[1]);
  }
  EXPECT_EQ(materials.size(), k_images);
  request.overrides = {"materials.vary={\"*.kd\"={hsv=[[0,1],[0.5,0.9],[0.3,0.9]],per=\"model\"}}"};
  materials.clear();
  for (const PlannedImage& image : plan().images)
    materials.insert(image.keys.parts[1]);
  EXPECT_LE(materials.size(), 4U);  // two models, of two materials at most
  // The file's own value is no change, and a property that nothing has an error.
  request.overrides = {
      "materials.vary={\"red.kd?\"=[0.7,0.1,0.1],\"*.kd?\"={choice=[0.5]},"
      "\"r*d.kd?\"=[0.7,0.1,0.1],\"green.kd?\"=[0.1,0.6,0.1]}"};
  for (std::size_t i = 0; i < after.images.size(); ++i)
    EXPECT_NE(plan().images[i].keys.render, Hash128{});
}

TEST_F(DrawsTest, APatternMustNameAProperty) {
  const auto message = [&](const std::string& vary) -> std::string {
    request.overrides = {"materials.vary={" + vary + "}"};
    try {
      plan();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message("\"*.roughness?\"=0.1"),
              testing::HasSubstr("\"*.roughness?\" names no property of any material"));
  EXPECT_THAT(message("\"red.kd\"=0.1"),
              testing::HasSubstr("must name a property of each material, found none in green.mat"));
  EXPECT_THAT(message("\"kd\"=0.1"), testing::HasSubstr("must be NAME.PROPERTY"));
  EXPECT_THAT(message("\"*.kd\"={uniform=[0,2]}"), testing::HasSubstr("in [0, 1]"));
  EXPECT_THAT(message("\"*.kd\"={ball=1}"),
              testing::HasSubstr("{ball} gives another kind of value"));
  EXPECT_THAT(message("\"*.kd\"={unifrom=[0,1]}"), testing::HasSubstr("did you mean uniform?"));
  EXPECT_EQ(message("\"red.kd?\"=0.1"), "");
}

// Of each key that the reference says may be drawn: it is, and its values are in the manifest's place.
TEST_F(DrawsTest, EveryKeyThatMayBeDrawnIs) {
  const std::map<std::string, std::vector<std::string>> needed = {
      {"camera.position_m", {"camera.set=\"random\""}},
      {"camera.extent_m", {"camera.type=\"orthographic\""}},
      {"camera.focus_distance_m", {"camera.focus=\"distance\""}}};
  for (const VariableKey& row : variable_keys()) {
    const std::string key(row.key);
    if (key.starts_with("distractors.")) continue;  // distractors_test.cc
    std::string drawn;
    if (row.kind == DrawnKind::rotation)
      drawn = "{rotation=\"any\"}";
    else if (row.kind == DrawnKind::point)
      drawn = "{shell=[0.2,0.3]}";
    else if (row.kind == DrawnKind::integer)
      drawn = "{integer=[60,95]}";
    else
      drawn = key.ends_with("_k") ? "{uniform=[3000,5000]}" : "{uniform=[0.2,0.3]}";
    request.overrides.clear();
    if (const auto with = needed.find(key); with != needed.end()) request.overrides = with->second;
    request.overrides.push_back(key + "=" + drawn);
    const Plan drawn_plan = plan();
    std::set<std::vector<double>> values;
    for (const PlannedImage& image : drawn_plan.images) {
      ASSERT_FALSE(image.error) << key << " " << image.error->what();
      const ImageVariables& variables = *image.spec.variables;
      ASSERT_EQ(variables.draws.size(), 1U) << key;
      Variables copy = variables.values;
      const double* const placed = row.at(copy);
      values.insert({placed, placed + width_of(row.kind)});
      for (std::size_t i = 0; i < width_of(row.kind); ++i)
        EXPECT_EQ(placed[i], variables.draws[0][i]) << key;
    }
    EXPECT_EQ(values.size(), row.per == DrawnPer::model ? 2U : drawn_plan.images.size()) << key;
  }
}

}  // namespace
}  // namespace ds
