// SPDX-License-Identifier: Apache-2.0
// What distractors make stale, and what they leave alone.
#include "builder/plan/distractors.h"
#include "tests/builder/tiny_dataset.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace ds {
namespace {

class DistractorKeys : public TinyDataset {
 protected:
  DistractorKeys() {
    std::filesystem::create_directory(recipe_folder() / "others");
    for (const auto& [from, to] : {std::pair("box.off", "brick.off"), {"tetra.ply", "wedge.ply"}})
      std::filesystem::copy(recipe_folder() / "models" / from, recipe_folder() / "others" / to);
  }
  Plan plan_with(std::vector<std::string> more = {}) {
    request.overrides = {"distractors.dir=\"" + (recipe_folder() / "others").string() + "\"",
                         "distractors.count=2", "distractors.place_m={disc=[0.1,0.3]}",
                         "distractors.size_m=0.05",
                         "outputs.planes=[\"mask\",\"amodal_mask\",\"object_id\",\"material_id\","
                         "\"albedo\",\"shading_normal\",\"direct_diffuse\"]"};
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
};

TEST_F(DistractorKeys, NoneAreAsIfTheRecipeDidNotKnowThem) {
  const Plan none = plan_with({"distractors.count=0"});
  request.overrides = {request.overrides[4]};
  const Plan without = plan();
  EXPECT_TRUE(moved(none, without).empty());
  for (std::size_t i = 0; i < none.images.size(); ++i)
    EXPECT_EQ(none.images[i].keys.parts, without.images[i].keys.parts);
}

TEST_F(DistractorKeys, EachPropertyMovesWhatShowsIt) {
  const std::set<std::string> all{"image",  "mask",           "object_id",     "material_id",
                                  "albedo", "shading_normal", "direct_diffuse"};
  const Plan before = plan_with();
  // The model alone is what it was.
  EXPECT_EQ(moved(before, plan_with({"distractors.count=1"})), all);
  EXPECT_EQ(moved(before, plan_with({"distractors.size_m=0.06"})), all);
  EXPECT_EQ(moved(before, plan_with({"distractors.turn={rotation=\"up\"}"})), all);
  EXPECT_EQ(moved(before, plan_with({"distractors.place_m={disc=[0.1,0.31]}"})), all);
  EXPECT_EQ(moved(before, plan_with({"distractors.gap_m=0.006"})), std::set<std::string>{});
  edit("others/brick.off", "-1 -1 -2", "-1 -1 -3");
  EXPECT_EQ(moved(before, plan_with()), all);
  edit("others/brick.off", "-1 -1 -3", "-1 -1 -2");
  EXPECT_EQ(moved(before, plan_with()), std::set<std::string>{});
  // A colour is in what shows colours, an id of a material in what shows that.
  edit("materials/red.mat", "0.", "0.1");
  EXPECT_EQ(moved(before, plan_with()),
            (std::set<std::string>{"image", "albedo", "direct_diffuse"}));
}

TEST_F(DistractorKeys, WhatIsOfTheSceneIsSaidOfThem) {
  const std::string mask = "outputs.planes=[\"mask\"]";
  plan_with({mask});
  build();
  EXPECT_TRUE(stale().empty());
  const Plan after = plan_with({mask, "distractors.size_m=0.06"});
  for (const PlannedImage& image : after.images)
    EXPECT_THAT(image.reasons,
                testing::Contains("distractors changed: distractors[1].size_m: 0.05 -> 0.06"))
        << image.spec.id;
}

TEST_F(DistractorKeys, AModelMoreMovesNoOtherImage) {
  const auto keys = [](const Plan& of) {
    std::map<std::string, std::pair<Hash128, Hash128>> all;
    for (const PlannedImage& image : of.images)
      all[image.spec.id] = {image.keys.render, image.keys.files};
    return all;
  };
  const auto before = keys(plan_with());
  std::filesystem::copy(recipe_folder() / "models/box.off", recipe_folder() / "models/third.off");
  const auto third = keys(plan_with());
  for (const auto& [id, key] : before)
    EXPECT_EQ(third.at(id), key) << id;
}

TEST_F(DistractorKeys, PlacesKeepThemApartAndOffTheCamera) {
  const Plan made = plan_with({"distractors.count=15", "distractors.place_m={disc=0.25}",
                               "distractors.gap_m=0.02", "camera.elevation_deg=3"});
  std::size_t shown = 0, unplaced = 0;
  for (const PlannedImage& image : made.images) {
    const std::vector<Distractor>& others = *image.spec.distractors;
    shown += others.size();
    unplaced += static_cast<std::size_t>(image.spec.unplaced);
    EXPECT_EQ(others.size() + static_cast<std::size_t>(image.spec.unplaced), 15U);
    for (std::size_t i = 0; i < others.size(); ++i) {
      const auto& a = others[i].values.distractor_place_m;
      const Vec3d eye = image.spec.camera.position;
      // The box is 0.05 long and 0.025 wide, so that its circle is 0.028 at most; the tetrahedron's 0.036.
      EXPECT_GT(std::hypot(a[0] - eye.x, a[1] - eye.y), 0.02 + 0.0125);
      EXPECT_GT(std::hypot(a[0], a[1]), 0.02 + 0.0125 + 0.04);
      for (std::size_t j = 0; j < i; ++j) {
        const auto& b = others[j].values.distractor_place_m;
        EXPECT_GT(std::hypot(a[0] - b[0], a[1] - b[1]), 0.02 + 0.025);
      }
    }
  }
  EXPECT_GT(shown, 40U);
  EXPECT_GT(unplaced, 0U);
  EXPECT_TRUE(touch({0, 0, 1, 0, 1}, {2.4, 0, 1, 0, 1}, 0.5));
  EXPECT_FALSE(touch({0, 0, 1, 0, 1}, {2.6, 0, 1, 0, 1}, 0.5));
}

}  // namespace
}  // namespace ds
