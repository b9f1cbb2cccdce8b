// SPDX-License-Identifier: Apache-2.0
// Distributions that change nothing are said to; those that change something are not.
#include "tests/builder/tiny_dataset.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace ds {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class IdleDraws : public TinyDataset {
 protected:
  std::vector<std::string> idle(std::vector<std::string> overrides) {
    request.overrides = std::move(overrides);
    Plan made = plan();
    for (const PlannedImage& image : made.images)
      EXPECT_FALSE(image.error) << image.error->what();
    return concern(made.concerns, "draws_idle").examples;
  }
  std::string only(const char* environment) const {
    return "environments.files=[\"" + (recipe_folder() / "environments" / environment).string() +
           "\"]";
  }
};

const char* const k_gain = "environments.gain={uniform=[1,2]}";
const char* const k_turn = "environments.turn_deg={uniform=[0,90]}";

TEST_F(IdleDraws, OfLightWhereThereIsNone) {
  EXPECT_THAT(idle({k_gain, only("floor")}), IsEmpty());
  edit("environments/floor/environment.scn", "sky.color = 1.0 1.0 1.0", "sky.color = 0 0 0");
  EXPECT_THAT(idle({k_gain, "environments.temperature_k={uniform=[3000,4000]}", only("floor")}),
              ElementsAre("environments.gain (no environment has light)",
                          "environments.temperature_k (no environment has light)"));
  EXPECT_THAT(idle({k_gain}), IsEmpty());  // the other one has
}

TEST_F(IdleDraws, OfATurnThatNobodySees) {
  EXPECT_THAT(idle({k_turn, only("plain")}),
              ElementsAre("environments.turn_deg (environments are alike from all sides)"));
  EXPECT_THAT(idle({k_turn}), IsEmpty());
  edit("environments/plain/environment.scn", "scene.lights.sky.color",
       "scene.lights.sun.type = sharpdistant\nscene.lights.sky.color");
  EXPECT_THAT(idle({k_turn, only("plain")}), IsEmpty());
}

TEST_F(IdleDraws, OfAPropertyInWhosePlaceAnotherCounts) {
  edit(
      "environments/floor/environment.scn", "scene.lights.sky.color",
      "scene.lights.lamp.type = point\nscene.lights.lamp.position = 0 0 1\nscene.lights.sky.color");
  const std::string power = "\"floor/lamp.power\"={uniform=[10,20]}",
                    efficiency = "\"floor/lamp.efficiency\"={uniform=[5,10]}";
  const auto vary = [](const std::string& text) { return "environments.vary={" + text + "}"; };
  // Watts count for nothing without lumens a watt, and lumens without watts.
  EXPECT_THAT(
      idle({vary(power)}),
      ElementsAre(
          "environments.vary.floor/lamp.power (without effect beside what else its thing has)"));
  EXPECT_THAT(idle({vary(power + "," + efficiency)}), IsEmpty());
  EXPECT_THAT(idle({vary("\"floor/lamp.gain\"={uniform=[1,2]}")}), IsEmpty());
  EXPECT_THAT(idle({vary("\"floor/lamp.gain\"=2")}), IsEmpty());
}

TEST_F(IdleDraws, OfPicturesWhereNoneIsMade) {
  const std::vector<std::string> keys{k_gain, "camera.lens_radius_m={uniform=[0,0.01]}",
                                      "outputs.camera.noise={uniform=[0.01,0.02]}",
                                      "camera.fov_deg={uniform=[40,50]}"};
  EXPECT_THAT(idle(keys), IsEmpty());
  std::vector<std::string> masks = keys;
  masks.emplace_back("outputs.image=false");
  EXPECT_THAT(idle(masks), ElementsAre("environments.gain (no picture is made)",
                                       "camera.lens_radius_m (no picture is made)",
                                       "outputs.camera.noise (no picture is made)"));
  masks.emplace_back("outputs.planes=[\"direct_diffuse\"]");
  EXPECT_THAT(idle(masks), ElementsAre("outputs.camera.noise (no picture is made)"));
}

}  // namespace
}  // namespace ds
