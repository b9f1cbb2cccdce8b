// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/keys.h"

#include "builder/recipe/settings.h"
#include "tests/builder/recipe_folder.h"
#include "tests/reference_page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

namespace ds {
namespace {

TEST(RecipeKeys, AreUniqueAndSortedIntoSections) {
  std::set<std::string_view> names, closed;
  std::string_view section;
  for (const KeySpec& key : recipe_keys()) {
    EXPECT_TRUE(names.insert(key.name).second) << key.name;
    const std::string_view own = key.name.substr(0, key.name.find('.'));
    if (own != section) {
      EXPECT_TRUE(closed.insert(own).second) << "section " << own << " stands twice";
      section = own;
    }
    EXPECT_FALSE(key.help.empty()) << key.name;
  }
}

TEST(RecipeKeys, HaveDefaultsThatTheyAllowThemselves) {
  for (const KeySpec& key : recipe_keys()) {
    if (key.has_default()) {
      EXPECT_TRUE(fits(key, parse_value(key.default_value))) << key.name;
    }
  }
}

TEST(RecipeKeys, DependOnChoicesThatExist) {
  for (const KeySpec& key : recipe_keys()) {
    if (key.only_with.empty()) continue;
    const KeyCondition condition = condition_of(key);
    const KeySpec* chooser = find_key(condition.key);
    ASSERT_NE(chooser, nullptr) << key.name;
    int matched = 0, literals = 1;
    for (const char c : key.only_with)
      literals += c == '|' ? 1 : 0;
    std::string_view rest = chooser->choices;
    while (!rest.empty()) {
      const std::size_t end = rest.find(" | ");
      matched += is_choice(condition.literals, rest.substr(0, end)) ? 1 : 0;
      rest.remove_prefix(end == rest.npos ? rest.size() : end + 3);
    }
    EXPECT_EQ(matched, literals) << key.name;
  }
}

// What a recipe leaves out is what the structs of the lower layers start with.
TEST(RecipeKeys, HaveTheDefaultsOfTheStructsTheyFill) {
  const RecipeFolder folder;
  const Recipe recipe = folder.read("outputs.tone_map = \"linear\"");
  const EngineSettings engine;
  EXPECT_EQ(recipe.engine.width, engine.width);
  EXPECT_EQ(recipe.engine.height, engine.height);
  EXPECT_EQ(recipe.engine.spp, engine.spp);
  EXPECT_FALSE(recipe.engine.target);
  EXPECT_EQ(folder.read("engine.error = 0.5").engine.target->max_spp, ErrorTarget{}.max_spp);
  EXPECT_EQ(folder.read("engine.error = 0.5").engine.target->region, ErrorTarget{}.region);
  EXPECT_EQ(
      folder.read("engine.error = 0.5\nengine.error_region = \"model\"").engine.target->region,
      ErrorRegion::model);
  EXPECT_EQ(recipe.engine.outlier_limit, engine.outlier_limit);
  EXPECT_EQ(recipe.rejected_limit, Recipe{}.rejected_limit);
  EXPECT_EQ(recipe.engine.depth_total, engine.depth_total);
  EXPECT_EQ(recipe.engine.depth_diffuse, engine.depth_diffuse);
  EXPECT_EQ(recipe.engine.depth_glossy, engine.depth_glossy);
  EXPECT_EQ(recipe.engine.depth_specular, engine.depth_specular);
  EXPECT_EQ(recipe.engine.roulette_depth, engine.roulette_depth);
  EXPECT_EQ(recipe.engine.roulette_cap, engine.roulette_cap);
  EXPECT_EQ(recipe.engine.filter_width, engine.filter_width);
  EXPECT_EQ(recipe.engine.math, engine.math);
  const NormaliseOptions normalise;
  EXPECT_EQ(recipe.normalise.up, normalise.up);
  EXPECT_EQ(recipe.normalise.size_m, normalise.size_m);
  EXPECT_EQ(recipe.normalise.place_on_ground, normalise.place_on_ground);
  EXPECT_EQ(recipe.normalise.ground_z_m, normalise.ground_z_m);
  EXPECT_EQ(recipe.normalise.centre, normalise.centre);
  EXPECT_EQ(recipe.normalise.normals, normalise.normals);
  EXPECT_EQ(recipe.normalise.crease_deg, normalise.crease_deg);
  const Camera camera;
  EXPECT_EQ(recipe.cameras[0].position, camera.position);
  EXPECT_EQ(recipe.cameras[0].target, camera.target);
  EXPECT_EQ(recipe.cameras[0].up, camera.up);
  EXPECT_EQ(recipe.cameras[0].fov_deg, camera.fov_deg);
  EXPECT_EQ(recipe.cameras[0].lens_radius_m, camera.lens_radius_m);
  EXPECT_EQ(recipe.cameras[0].focus_distance_m, camera.focus_distance_m);
  const ToneMap map;
  ASSERT_TRUE(recipe.outputs.tone_map);
  EXPECT_EQ(recipe.outputs.tone_map->scale, map.scale);
  EXPECT_EQ(recipe.outputs.tone_map->prescale, map.prescale);
  EXPECT_EQ(recipe.outputs.tone_map->postscale, map.postscale);
  EXPECT_EQ(recipe.outputs.tone_map->burn, map.burn);
  EXPECT_EQ(recipe.outputs.tone_map->gamma, map.gamma);
  ASSERT_EQ(recipe.outputs.planes.size(), 1U);
  EXPECT_EQ(recipe.outputs.planes[0].type->name, "mask");
  EXPECT_EQ(recipe.keep_film, Recipe{}.keep_film);
  EXPECT_EQ(recipe.seed, Recipe{}.seed);
  EXPECT_EQ(recipe.assign_materials, Recipe{}.assign_materials);
  EXPECT_EQ(recipe.assign_environments, Recipe{}.assign_environments);
}

TEST(RecipeKeys, RangesSayWhatTheyMean) {
  const KeyRange open{0, 180, true, true};
  EXPECT_FALSE(open.contains(0));
  EXPECT_TRUE(open.contains(1e-9));
  EXPECT_FALSE(open.contains(180));
  EXPECT_EQ(open.text(), "in (0, 180)");
  const KeyRange closed{.least = 1, .most = 2};
  EXPECT_TRUE(closed.contains(1));
  EXPECT_TRUE(closed.contains(2));
  EXPECT_FALSE(closed.contains(2.5));
  EXPECT_EQ(closed.text(), "in [1, 2]");
  EXPECT_EQ((KeyRange{.least = 0}.text()), ">= 0");
  EXPECT_EQ((KeyRange{.most = 3}.text()), "<= 3");
  const KeyRange any;
  EXPECT_EQ(any.text(), "");
  EXPECT_FALSE(any.contains(std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(any.contains(std::numeric_limits<double>::quiet_NaN()));
}

TEST(RecipeKeys, NearMissesAreRecognised) {
  EXPECT_EQ(nearest_key("dataset.license"), "dataset.licence");
  EXPECT_EQ(nearest_key("camera.normalize"), "camera.normalise");
  EXPECT_EQ(nearest_key("camera.fov"), "camera.fov_deg");
  EXPECT_EQ(nearest_key("engine.fov_deg"), "camera.fov_deg");
  EXPECT_EQ(nearest_key("modles.dir"), "models.dir");
  // A key that there is, in another section, is nearer than one of this section that looks like it.
  EXPECT_EQ(nearest_key("camera.normals"), "models.normals");
  EXPECT_EQ(nearest_key("engine.mask"), "outputs.mask");
  EXPECT_EQ(nearest_key("models.spp"), "engine.spp");
  EXPECT_EQ(nearest_key("spp"), "engine.spp");
  EXPECT_EQ(nearest_key("camera.shutter"), "");
}

TEST(RecipeReference, IsWhatTheReadmeHolds) {
  ds::testing::expect_page_holds("recipes/README.md", recipe_reference());
}

}  // namespace
}  // namespace ds
