// SPDX-License-Identifier: Apache-2.0
// [[lights]]: what an image's lights are, and what moves none of them.
#include "builder/recipe/lights.h"

#include "builder/recipe/keys.h"
#include "tests/builder/recipe_folder.h"
#include "tracer/scene/colour_temperature.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/told_lights.h"
#include "tracer/scene/type_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace ds {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::string_view k_lamps = R"(
[[lights]]
type = "point"
count = { integer = [0, 3] }
position_m = { shell = [0.4, 0.8], elevation_deg = [20, 90] }
gain = { log_uniform = [1, 20] }
temperature_k = { uniform = [2700, 7500] }
color = { hsv = [[0, 1], [0.1, 0.3], [0.8, 1]], per = "model" }
)";
constexpr std::string_view k_sunlight = R"(
[[lights]]
type = "distant"
name = "window"
from = { sphere = 1, elevation_deg = [10, 80] }
theta = { uniform = [1, 10] }
)";

class LightsTest : public testing::Test {
 protected:
  Recipe recipe(std::string_view text, const std::vector<std::string>& overrides = {}) const {
    return folder_.read(text, overrides);
  }
  /// Of all images, by image and light.
  static std::map<std::string, std::string> shown(const Recipe& recipe) {
    std::map<std::string, std::string> all;
    for (const ImageSpec& image : expand(recipe))
      for (const Light& light : lights_of(image, recipe))
        all[image.id + " " + light.name] = canonical_lights({light});
    return all;
  }

  RecipeFolder folder_;
};

TEST_F(LightsTest, AreDrawnByTheRuleOfDraws) {
  const Recipe read = recipe(k_lamps);
  ASSERT_EQ(read.lights.size(), 1U);
  EXPECT_EQ(read.lights[0].most, 3);
  // A count, and of each of three what it is.
  ASSERT_EQ(read.drawn.size(), 1U + 3 * 4);
  std::set<std::size_t> counts;
  for (const ImageSpec& image : expand(read)) {
    const DrawnFor of{read.seed, *image.model_name, *image.view, 0, 0};
    const auto value = [&](const std::string& key) {
      for (const Drawn& drawn : read.drawn)
        if (drawn.key == key) return draw(drawn.distribution, key, of);
      ADD_FAILURE() << key;
      return DrawnValue{};
    };
    const std::vector<Light> lights = lights_of(image, read);
    EXPECT_EQ(static_cast<double>(lights.size()), value("lights[0].count")[0]);
    counts.insert(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
      const std::string name = i == 0 ? "lights[0]" : "lights[0][" + std::to_string(i) + "]";
      EXPECT_EQ(lights[i].name, name);
      EXPECT_EQ(type_of(lights[i]).name, "point");
      const DrawnValue place = value(name + ".position_m"), colour = value(name + ".color");
      const Vec3 found = light_vector(lights[i], "position");
      EXPECT_EQ(found, to_float(Vec3d{place[0], place[1], place[2]}));
      const double radius = length(to_double(found));
      EXPECT_GE(radius, 0.4 - 1e-6);
      EXPECT_LE(radius, 0.8 + 1e-6);
      EXPECT_GE(double{found.z} / radius, std::sin(20 * std::numbers::pi / 180) - 1e-6);
      // Its gain goes to all sides.
      const Vec3d body = black_body_colour(value(name + ".temperature_k")[0]);
      const double gain = value(name + ".gain")[0] / (4 * std::numbers::pi);
      EXPECT_NEAR(lights[i].color.x, gain * colour[0] * body.x, 1e-6 * gain);
      EXPECT_NEAR(lights[i].color.y, gain * colour[1] * body.y, 1e-6 * gain);
      EXPECT_NEAR(lights[i].color.z, gain * colour[2] * body.z, 1e-6 * gain);
    }
  }
  EXPECT_EQ(counts, (std::set<std::size_t>{0, 1, 2, 3}));
}

TEST_F(LightsTest, AreMovedByNothingElse) {
  const std::string both = std::string(k_lamps) + std::string(k_sunlight);
  const auto before = shown(recipe(both));
  ASSERT_GT(before.size(), 40U);
  const auto same_where_both = [&](const std::map<std::string, std::string>& after) {
    std::size_t common = 0;
    for (const auto& [name, light] : before)
      if (const auto at = after.find(name); at != after.end()) {
        EXPECT_EQ(at->second, light) << name;
        ++common;
      }
    return common;
  };
  // Other keys drawn, other assignments, an entry that has a name before the others.
  EXPECT_EQ(same_where_both(shown(recipe("camera.fov_deg = { uniform = [40, 60] }\n"
                                         "materials.assign = \"cycle\"\n"
                                         "environments.turn_deg = { uniform = [0, 90] }\n" +
                                         both))),
            before.size());
  EXPECT_EQ(same_where_both(shown(recipe(std::string(k_lamps) +
                                         "[[lights]]\ntype = \"sun\"\n"
                                         "from = [0, 0, 1]\n" +
                                         std::string(k_sunlight)))),
            before.size());
  // More of them, and one model more.
  std::string more = both;
  more.replace(more.find("[0, 3]"), 6, "[3, 3]");
  folder_.add("models/sofa.off");
  EXPECT_EQ(same_where_both(shown(recipe(more))), before.size());
  // Another distribution of one key leaves the others.
  std::string warmer = both;
  warmer.replace(warmer.find("[2700, 7500]"), 12, "[2700, 2800]");
  std::size_t moved = 0;
  for (const auto& [name, light] : shown(recipe(warmer))) {
    const auto at = before.find(name);
    if (at == before.end()) continue;
    const auto place = [](const std::string& text) { return text.substr(text.find(".position")); };
    if (name.find("window") != name.npos)
      EXPECT_EQ(light, at->second);
    else
      EXPECT_EQ(place(light), place(at->second));
    moved += light == at->second ? 0U : 1U;
  }
  EXPECT_GT(moved, 10U);
}

TEST_F(LightsTest, StandWhereTheModelStands) {
  const Recipe read = recipe(
      "models.place_m = { disc = 0.2 }\n[[lights]]\ntype = \"spot\"\nposition_m = [0, 0, 0.5]\n"
      "coneangle = 20\n[[lights]]\ntype = \"sharpdistant\"\nfrom = [0, 3, 4]\n");
  std::set<double> places;
  for (const ImageSpec& image : expand(read)) {
    const auto& place = image.variables->values.model_place_m;
    const std::vector<Light> lights = lights_of(image, read);
    EXPECT_EQ(light_vector(lights[0], "position"),
              to_float(Vec3d{place[0], place[1], place[2] + 0.5}));
    // At the model, straight down, wherever that is.
    EXPECT_NEAR(light_vector(lights[0], "direction").z, -1, 1e-6);
    EXPECT_EQ(light_vector(lights[1], "direction"), (Vec3{0, -0.6F, -0.8F}));
    places.insert(place[0]);
  }
  EXPECT_GT(places.size(), 5U);
}

// A light of a recipe is the one that a file with the same numbers has.
TEST_F(LightsTest, AreThoseOfAFileWithTheSameNumbers) {
  folder_.add("same/environment.scn",
              "scene.lights.a.type = point\nscene.lights.a.position = 0.1 0.2 0.3\n"
              "scene.lights.a.power = 40\nscene.lights.a.efficiency = 15\n"
              "scene.lights.a.color = 0.5 0.25 1\n"
              "scene.lights.b.type = spot\nscene.lights.b.position = 1 0 1\n"
              "scene.lights.b.target = 0 0 0.1\nscene.lights.b.coneangle = 25\n"
              "scene.lights.b.conedeltaangle = 3\nscene.lights.b.gain = 7 7 7\n"
              "scene.lights.c.type = distant\nscene.lights.c.direction = 0 -1 -2\n"
              "scene.lights.c.theta = 4\n"
              "scene.lights.d.type = sun\nscene.lights.d.dir = 0.1 0.2 0.9\n"
              "scene.lights.d.turbidity = 3\nscene.lights.d.gain = 0.001 0.001 0.001\n"
              "scene.lights.e.type = constantinfinite\nscene.lights.e.color = 0.1 0.2 0.3\n");
  const Recipe read = recipe(
      "[[lights]]\ntype = \"point\"\nposition_m = [0.1, 0.2, 0.3]\npower = 40\nefficiency = 15\n"
      "color = [0.5, 0.25, 1]\n[[lights]]\ntype = \"spot\"\nposition_m = [1, 0, 1]\n"
      "target_m = [0, 0, 0.1]\nconeangle = 25\nconedeltaangle = 3\ngain = 7\n"
      "[[lights]]\ntype = \"distant\"\nfrom = [0, 1, 2]\ntheta = 4\n"
      "[[lights]]\ntype = \"sun\"\nfrom = [0.1, 0.2, 0.9]\nturbidity = 3\ngain = 0.001\n"
      "[[lights]]\ntype = \"constantinfinite\"\ncolor = [0.1, 0.2, 0.3]\n");
  Scene file = read_environment(folder_.path() / "same");
  std::vector<Light> lights = lights_of(expand(read).front(), read);
  ASSERT_EQ(lights.size(), file.lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i)
    lights[i].name = file.lights[i].name;
  EXPECT_EQ(canonical_lights(lights), canonical_lights(file.lights));
}

TEST_F(LightsTest, EveryTypeTakesADistributionForEachOfItsNumbers) {
  for (const SdlTypeRow* type : told_light_types()) {
    std::string text = "[[lights]]\ntype = \"" + type->name + "\"\n";
    std::size_t drawn = 0;
    for (const LightKey& key : light_keys(type->name)) {
      if (key.use == LightUse::flag) continue;
      const bool point = key.use == LightUse::point || key.use == LightUse::source;
      // Cones are wider than what of them falls off, suns above the horizon.
      const std::string numbers = key.name == "conedeltaangle"       ? "[2, 3]"
                                  : key.use == LightUse::temperature ? "[3000, 4000]"
                                  : key.name == "relsize"            ? "[1, 2]"
                                                                     : "[10, 20]";
      text += key.name + " = { " +
              (point                         ? "box = [[1, 2, 3], [2, 3, 4]]"
               : key.use == LightUse::colour ? "hsv = [[0, 1], [0, 1], [0.5, 1]]"
                                             : "uniform = " + numbers) +
              " }\n";
      ++drawn;
    }
    const Recipe read = recipe(text);
    EXPECT_EQ(read.drawn.size(), drawn) << type->name;
    std::set<std::string> different;
    const std::vector<ImageSpec> images = expand(read);
    for (const ImageSpec& image : images)
      different.insert(canonical_lights(lights_of(image, read)));
    EXPECT_EQ(different.size(), images.size()) << type->name;
  }
}

TEST_F(LightsTest, WhatIsWrongWithThemIsSaidAtItsPlace) {
  const auto said = [&](const std::string& text) { return folder_.findings(text); };
  for (const char* text : {"[lights]\ntype = \"point\"\n", "lights = { type = \"point\" }\n",
                           "[lights.lamp]\ntype = \"point\"\n"})
    EXPECT_THAT(said(text), AllOf(HasSubstr("lights must be a list of tables"),
                                  HasSubstr("; each begins with [[lights]], two brackets")))
        << text;
  EXPECT_THAT(said("lights = [3]\n"), HasSubstr("lights must be a list of tables, got 3"));
  EXPECT_THAT(said("[[lights]]\ngain = 2\n"),
              HasSubstr("lights[0].type must be given: one of point, spot, "));
  EXPECT_THAT(said("[[lights]]\ntype = \"pint\"\n"), HasSubstr("did you mean point?"));
  EXPECT_THAT(said("[[lights]]\ntype = \"infinite\"\n"),
              HasSubstr("lights[0].type must be one of"));
  const std::string lamp = "[[lights]]\ntype = \"point\"\nposition_m = [0, 0, 1]\n";
  EXPECT_EQ(said(lamp), "");
  EXPECT_THAT(said("[[lights]]\ntype = \"point\"\n"),
              HasSubstr("lights[0].position_m must be given: a list of three numbers"));
  EXPECT_THAT(said(lamp + "gian = 2\n"),
              HasSubstr("r.toml:7:8: lights[0].gian is no key of a point "
                        "light, did you mean gain?"));
  EXPECT_THAT(said(lamp + "theta = 2\n"), HasSubstr("lights[0].theta is no key of a point light"));
  EXPECT_THAT(said(lamp + "gain = -2\n"),
              HasSubstr("lights[0].gain must be a number >= 0 or a distribution, got -2"));
  EXPECT_THAT(said(lamp + "gain = { uniform = [-1, 2] }\n"), HasSubstr("lights[0].gain"));
  EXPECT_THAT(said(lamp + "gain = { disc = 2 }\n"),
              HasSubstr("lights[0].gain {disc} gives another kind of value"));
  EXPECT_THAT(said(lamp + "count = 16\n"),
              HasSubstr("lights[0].count must be an integer in [0, 15]"));
  EXPECT_THAT(said(lamp + "count = { integer = [1, 16] }\n"), HasSubstr("lights[0].count"));
  EXPECT_THAT(said(lamp + "temperature_k = 500\n"), HasSubstr("lights[0].temperature_k"));
  EXPECT_THAT(said(lamp + "name = \"a.b\"\n"),
              HasSubstr("lights[0].name must be a string of letters"));
  EXPECT_THAT(said(lamp + "name = \"a\"\n" + lamp + "name = \"a\"\n"),
              HasSubstr("lights[1].name must be another one"));
  EXPECT_THAT(said("[[lights]]\ntype = \"distant\"\nfrom = [0, 0, 0]\n"),
              HasSubstr("lights[0].from must be a list of three numbers"));
  // All at once.
  const std::string two = said(lamp + "gain = -2\ncolor = 3\n");
  EXPECT_THAT(two, HasSubstr("lights[0].gain"));
  EXPECT_THAT(two, HasSubstr("lights[0].color"));
}

TEST_F(LightsTest, NumbersThatDoNotGoTogetherAreAnErrorOfTheirImage) {
  const Recipe read = recipe(
      "[[lights]]\ntype = \"spot\"\nposition_m = [0, 0, 1]\nconeangle = { uniform = [1, 5] }\n"
      "conedeltaangle = 6\n");
  const ImageSpec image = expand(read).front();
  try {
    lights_of(image, read);
    ADD_FAILURE() << "a cone that falls off beyond itself";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::recipe);
    EXPECT_THAT(error.what(), HasSubstr(image.id + ": lights[0].conedeltaangle: wanted"));
  }
}

TEST_F(LightsTest, TheRecipeAsReadSaysTheSame) {
  const std::string both = std::string(k_lamps) + std::string(k_sunlight);
  const Recipe read = recipe(both);
  std::string lights;
  for (const auto& [key, text] : read.settings)
    if (key == "lights") lights = text;
  EXPECT_THAT(lights, HasSubstr("integer = [0, 3]"));
  EXPECT_THAT(lights, HasSubstr("gain = {log_uniform = [1.0, 20.0]}"));
  EXPECT_EQ(shown(recipe("lights = " + lights + "\n")), shown(read));
  EXPECT_EQ(shown(recipe("", {"lights=" + lights})), shown(read));
  EXPECT_TRUE(shown(recipe(both, {"lights=[]"})).empty());
}

}  // namespace
}  // namespace ds
