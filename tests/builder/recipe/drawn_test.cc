// SPDX-License-Identifier: Apache-2.0
// Distributions in recipes: how they are written, and what does not move them.
#include "builder/recipe/variables.h"
#include "tests/builder/recipe_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace ds {
namespace {

using testing::ElementsAre;

class DrawnTest : public testing::Test {
 protected:
  /// What every image has of a key, by id.
  static std::map<std::string, DrawnValue> draws(const Recipe& recipe, const std::string& key) {
    std::map<std::string, DrawnValue> values;
    for (std::size_t i = 0; i < recipe.drawn.size(); ++i)
      if (recipe.drawn[i].key == key)
        for (const ImageSpec& image : expand(recipe))
          values[image.id] = image.variables->draws[i];
    return values;
  }
  std::map<std::string, DrawnValue> fov(std::string_view text,
                                        const std::vector<std::string>& overrides = {}) const {
    return draws(folder_.read(text, overrides), "camera.fov_deg");
  }

  RecipeFolder folder_;
};

constexpr std::string_view k_fov = "camera.fov_deg = { uniform = [40, 60] }\n";

TEST_F(DrawnTest, ReachTheCameraOfEachImage) {
  const Recipe recipe = folder_.read(
      "camera.set = \"orbit\"\ncamera.count = 3\n"
      "camera.fov_deg = { uniform = [40, 60] }\ncamera.distance_m = { uniform = [1, 2] }\n"
      "camera.elevation_deg = { uniform = [10, 50] }\ncamera.target = { ball = 0.02 }\n"
      "camera.lens_radius_m = { choice = [0, 0.001], weights = [2, 1] }\n"
      "camera.azimuth_deg = { spread = [0, 10] }\nenvironments.turn_deg = { cycle = [0, 90] }\n"
      "environments.gain = { log_uniform = [0.5, 2], per = \"model\" }\n");
  ASSERT_EQ(recipe.drawn.size(), 8U);
  std::map<std::string, std::set<double>> gains;
  for (const ImageSpec& image : expand(recipe)) {
    std::map<std::string, DrawnValue> drawn;
    for (std::size_t i = 0; i < recipe.drawn.size(); ++i)
      drawn[recipe.drawn[i].key] = image.variables->draws[i];
    const Camera& camera = image.camera;
    EXPECT_EQ(camera.fov_deg, drawn["camera.fov_deg"][0]);
    EXPECT_EQ(camera.target.y, drawn["camera.target"][1]);
    EXPECT_EQ(camera.lens_radius_m, drawn["camera.lens_radius_m"][0]);
    const Vec3d away = camera.position - camera.target;
    EXPECT_NEAR(length(away), drawn["camera.distance_m"][0], 1e-14);
    EXPECT_NEAR(std::asin(away.z / length(away)) * 180 / 3.14159265358979323846,
                drawn["camera.elevation_deg"][0], 1e-12);
    EXPECT_EQ(image.variables->values.environment_turn_deg, drawn["environments.turn_deg"][0]);
    gains[*image.model_name].insert(image.variables->values.environment_gain);
  }
  std::set<double> all;
  for (const auto& [model, of_model] : gains) {
    EXPECT_EQ(of_model.size(), 1U) << model;
    all.insert(*of_model.begin());
  }
  EXPECT_EQ(all.size(), 3U);
}

TEST_F(DrawnTest, AreMovedByNothingElse) {
  const auto before = fov(k_fov);
  ASSERT_EQ(before.size(), 42U);
  // Another order of the file, more keys, other materials and environments.
  EXPECT_EQ(
      fov("environments.gain = { uniform = [1, 2] }\ncamera.target = { box = [[0, 0, 0], [0.01, "
          "0, 0]] }\n" +
          std::string(k_fov)),
      before);
  EXPECT_EQ(fov(k_fov,
                {"materials.files=[\"" + (folder_.path() / "materials/clay.mat").string() + "\"]"}),
            before);
  // Fewer views, more views, another model.
  for (const auto& [id, value] : fov(std::string(k_fov) + "camera.views = [3, 7]\n"))
    EXPECT_EQ(value, before.at(id)) << id;
  folder_.add("models/anvil.ply");
  const auto more = fov(k_fov);
  EXPECT_EQ(more.size(), 56U);
  for (const auto& [id, value] : before)
    EXPECT_EQ(more.at(id), value) << id;
  // The seed moves them all.
  for (const auto& [id, value] : fov(std::string(k_fov) + "dataset.seed = 1\n"))
    EXPECT_NE(value, more.at(id)) << id;
}

TEST_F(DrawnTest, AreSharedByAnImagesMaterialsAndEnvironments) {
  std::map<std::string, std::set<double>> by_view;
  for (const ImageSpec& image :
       expand(folder_.read(std::string(k_fov) + "materials.assign = \"all\"\n")))
    by_view[*image.model_name + *image.view].insert(image.camera.fov_deg);
  EXPECT_EQ(by_view.size(), 42U);
  for (const auto& [view, values] : by_view)
    EXPECT_EQ(values.size(), 1U) << view;
}

TEST_F(DrawnTest, MayBeGivenByTheCommandLine) {
  EXPECT_EQ(fov("", {"camera.fov_deg={uniform=[40,60]}"}), fov(k_fov));
  EXPECT_EQ(folder_.findings("", {"camera.fov_deg={unifrom=[40,60]}"}),
            "--set camera.fov_deg: {unifrom} is no distribution, did you mean uniform?");
}

TEST_F(DrawnTest, StandInTheSettingsInOneSpelling) {
  const Recipe recipe = folder_.read(
      "camera.fov_deg = { weights = [2, 1], choice = [40, { within = [50, 60], normal = [55, 2] }] "
      "}");
  EXPECT_THAT(recipe.settings,
              testing::Contains(std::pair<std::string, std::string>(
                  "camera.fov_deg",
                  "{choice = [40.0, {normal = [55.0, 2.0], within = [50.0, 60.0]}], "
                  "weights = [2.0, 1.0]}")));
  EXPECT_EQ(recipe.drawn[0].text,
            "{choice = [40.0, {normal = [55.0, 2.0], within = [50.0, "
            "60.0]}], weights = [2.0, 1.0]}");
  // As canonical text it is the same recipe.
  const Recipe again = folder_.read("camera.fov_deg = " + recipe.drawn[0].text);
  EXPECT_EQ(draws(again, "camera.fov_deg"), draws(recipe, "camera.fov_deg"));
}

TEST_F(DrawnTest, OfOneValueAreThatValue) {
  const Recipe constant = folder_.read("camera.fov_deg = 50"),
               drawn = folder_.read("camera.fov_deg = { uniform = [50, 50] }");
  const auto a = expand(constant), b = expand(drawn);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].camera.fov_deg, b[i].camera.fov_deg);
    EXPECT_EQ(a[i].camera.position, b[i].camera.position);
    EXPECT_EQ(a[i].camera.focus_distance_m, b[i].camera.focus_distance_m);
  }
}

TEST_F(DrawnTest, RandomCamerasStandWhereTheyAreDrawn) {
  const Recipe recipe = folder_.read(
      "camera.set = \"random\"\ncamera.count = 5\ncamera.target = [0, 0, 0.1]\n"
      "camera.position_m = { shell = [0.3, 0.4], elevation_deg = [10, 60] }\n");
  const auto images = expand(recipe);
  ASSERT_EQ(images.size(), 15U);
  for (const ImageSpec& image : images) {
    const Vec3d away = image.camera.position - Vec3d{0, 0, 0.1};
    EXPECT_GE(length(away), 0.3 - 1e-12);
    EXPECT_LT(length(away), 0.4 + 1e-12);
    EXPECT_GT(away.z / length(away), std::sin(0.17));
  }
  EXPECT_EQ(folder_.findings("camera.set = \"random\""),
            "r.toml: camera.position_m must be given with camera.set = \"random\"");
}

TEST_F(DrawnTest, ARollTurnsThePictureAndNothingElse) {
  const Camera level = expand(folder_.read(""))[8].camera,
               rolled = expand(folder_.read("camera.roll_deg = 30"))[8].camera;
  EXPECT_EQ(level.position, rolled.position);
  EXPECT_EQ(level.target, rolled.target);
  const Vec3d forward = normalized(level.target - level.position);
  const Vec3d right = normalized(cross(forward, level.up)), up = cross(right, forward);
  // The camera's up leans to its right by 30 degrees.
  EXPECT_NEAR(dot(normalized(rolled.up), right), 0.5, 1e-14);
  EXPECT_NEAR(dot(normalized(rolled.up), up), std::sqrt(0.75), 1e-14);
}

TEST_F(DrawnTest, ErrorsNameThePlaceAndAreToldTogether) {
  const auto finding = [&](const std::string& value, const std::string& key = "camera.fov_deg") {
    return folder_.findings(key + " = " + value);
  };
  EXPECT_EQ(
      finding("{ uniform = [60, 40] }"),
      "r.toml:4:30: camera.fov_deg {uniform} wants two numbers, the lesser first, got [60, 40]");
  EXPECT_EQ(finding("{ uniform = [40, 190] }"),
            "r.toml:4:30: camera.fov_deg {uniform} must give numbers in (0, 180), got 190");
  EXPECT_EQ(finding("{ unifrom = [40, 60] }"),
            "r.toml:4:30: camera.fov_deg {unifrom} is no distribution, did you mean uniform?");
  EXPECT_EQ(finding("{ uniform = [40, 60], spread = [1, 2] }"),
            "r.toml:4:30: camera.fov_deg must be one distribution, got spread and uniform");
  EXPECT_EQ(finding("{ normal = [50, 5] }"),
            "r.toml:4:18: camera.fov_deg {normal} must have within = [least, most] beside it");
  EXPECT_EQ(
      finding("{ normal = [50, 1], within = [70, 80] }"),
      "r.toml:4:29: camera.fov_deg {normal} must have within nearer than 12 deviations to the "
      "mean, got [70, 80]");
  EXPECT_EQ(finding("{ log_uniform = [0, 4] }", "environments.gain"),
            "r.toml:4:37: environments.gain {log_uniform} wants two numbers above 0, got [0, 4]");
  EXPECT_EQ(finding("{ choice = [40, 50], weights = [1] }"),
            "r.toml:4:49: camera.fov_deg {choice} wants 2 weights, one a value, got 1");
  EXPECT_EQ(
      finding("{ choice = [40, 50], weights = [0, 0] }"),
      "r.toml:4:49: camera.fov_deg {choice} wants weights = numbers >= 0, not all 0, got [0, 0]");
  EXPECT_EQ(finding("{ choice = [40, 40.0] }"),
            "r.toml:4:34: camera.fov_deg {choice} must name a value once, got 40.0 again; weights "
            "favour one");
  EXPECT_EQ(finding("{ cycle = [40, { uniform = [40, 50] }] }"),
            "r.toml:4:33: camera.fov_deg {cycle} wants constants, got {uniform = [40, 50]}");
  EXPECT_EQ(finding("{ choice = [40, 200] }"),
            "r.toml:4:34: camera.fov_deg must choose among numbers in (0, 180), got 200");
  EXPECT_EQ(
      finding("{ uniform = [40, 50], per = \"image\" }"),
      "r.toml:4:46: camera.fov_deg {uniform} wants per = \"view\", \"model\" or \"dataset\", got "
      "\"image\"");
  EXPECT_EQ(finding("{ shell = [1, 2] }"),
            "r.toml:4:28: camera.fov_deg {shell} gives another kind of value; here stand uniform, "
            "log_uniform, normal, choice, cycle, spread");
  EXPECT_EQ(
      finding("{ uniform = [1, 2] }", "engine.width"),
      "r.toml:4:16: engine.width must be an integer in [1, 16384], got {uniform = [1, 2]}; it "
      "takes no distribution");
  EXPECT_EQ(
      finding("{}"),
      "r.toml:4:18: camera.fov_deg must be a distribution, one of uniform, log_uniform, normal, "
      "choice, cycle, spread, got {}");
  EXPECT_EQ(
      folder_.findings("camera.fov_deg = { uniform = [60, 40] }\n"
                       "environments.gain = { uniform = 3 }\n"),
      "r.toml:4:30: camera.fov_deg {uniform} wants two numbers, the lesser first, got [60, 40]\n"
      "r.toml:5:33: environments.gain {uniform} wants two numbers, the lesser first, got 3");
  // Without effect.
  EXPECT_EQ(finding("{ uniform = [10, 20] }", "camera.elevation_deg"),
            "r.toml:4:24: camera.elevation_deg has no effect with camera.set = "
            "\"half-dodecahedron\", only with camera.set = \"orbit\"");
}

TEST(VariableKeys, AreKeysOfRecipes) {
  for (const VariableKey& row : variable_keys())
    EXPECT_NE(find_key(row.key), nullptr) << row.key;
}

}  // namespace
}  // namespace ds
