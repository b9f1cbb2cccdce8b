// SPDX-License-Identifier: Apache-2.0
// camera.keep: which views are drawn again, and what is said of it.
#include "manifests/manifest.h"
#include "tests/builder/tiny_dataset.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

namespace ds {
namespace {

class KeepTest : public TinyDataset {
 protected:
  Plan plan_with(std::vector<std::string> overrides) {
    request.overrides = std::move(overrides);
    return plan();
  }
};

const std::string k_around = "camera.target={ball=0.12}";
// Models that stand in the floor, more or less.
const std::string k_sunk = "models.place_m={box=[[0,0,-0.12],[0,0,0]]}";

// A rejected draw moves its own image, and an image whose first draw passes is what it was.
TEST_F(KeepTest, DrawsAgainWhatIsRejectedAndNothingElse) {
  const Plan all = plan_with({k_around}), kept = plan_with({k_around, "camera.keep.in_frame=0.95"});
  std::size_t again = 0;
  std::uint64_t draws = 0;
  for (std::size_t i = 0; i < kept.images.size(); ++i) {
    const PlannedImage &a = all.images[i], &b = kept.images[i];
    ASSERT_FALSE(b.error) << b.error->what();
    const int attempts = b.spec.variables->attempts;
    EXPECT_EQ(a.keys.render == b.keys.render, attempts == 0) << b.spec.id;
    again += attempts > 0;
    draws += static_cast<std::uint64_t>(attempts) + 1;
  }
  EXPECT_GT(again, 0U);
  EXPECT_LT(again, k_images);
  EXPECT_EQ(kept.drawn.draws, draws);
  EXPECT_EQ(kept.drawn.rejected.at("in_frame"), draws - k_images);
}

TEST_F(KeepTest, EveryKeptModelIsInTheFrame) {
  request.overrides = {k_around, "camera.keep.in_frame=0.95", "engine.width=64"};
  build();
  std::uint64_t attempts = 0;
  for (const ImageRecord& image : read_images_manifest(output())) {
    ASSERT_TRUE(image.pixel_counts.beyond);
    if (*image.pixel_counts.beyond > 0) {
      EXPECT_LE(double(*image.pixel_counts.beyond), 0.07 * double(*image.pixel_counts.whole))
          << image.id;
    }
    attempts += image.draw_attempts.value_or(0);
  }
  EXPECT_GT(attempts, k_images);
  // Without a condition nothing is counted, and the lines follow.
  request.overrides = {"camera.fov_deg={uniform=[50,50]}", "camera.keep.in_frame=0.1"};
  build();
  EXPECT_EQ(read_images_manifest(output())[0].draw_attempts, 1U);
  request.overrides = {"camera.fov_deg={uniform=[50,50]}"};
  build();
  EXPECT_TRUE(calls.traced.empty());
  EXPECT_EQ(read_images_manifest(output())[0].draw_attempts, std::nullopt);
}

TEST_F(KeepTest, AnImageWithoutAViewIsAnErrorOfThePlan) {
  const Plan none = plan_with({"camera.target={box=[[9,9,9],[10,10,10]]}",
                               "camera.keep.in_frame=0.5", "camera.keep.tries=3"});
  for (const PlannedImage& image : none.images) {
    ASSERT_TRUE(image.error);
    EXPECT_EQ(std::string(image.error->what()),
              image.spec.id + ": no view with in_frame >= 0.5 in 3 tries; best 0");
  }
  EXPECT_EQ(none.drawn.draws, 3 * k_images);
  // Where nothing is drawn, one look tells.
  const Plan constant = plan_with({"camera.target=[9,9,9]", "camera.keep.in_frame=0.5"});
  EXPECT_EQ(std::string(constant.images[0].error->what()),
            constant.images[0].spec.id + ": no view with in_frame >= 0.5 in 1 try; best 0");
}

TEST_F(KeepTest, VisibleIsWhatTheFloorLeavesOfTheModel) {
  std::size_t failed = 0;
  for (const PlannedImage& image :
       plan_with({k_sunk, "camera.keep.visible=0.6", "camera.keep.tries=1"}).images) {
    failed += image.error.has_value();
    if (image.error) {
      EXPECT_THAT(image.error->what(),
                  testing::HasSubstr("no view with visible >= 0.6 in 1 try; best 0"));
    }
  }
  EXPECT_GT(failed, 0U);
  EXPECT_LT(failed, k_images);
  for (const PlannedImage& image : plan_with({k_sunk, "camera.keep.visible=0.6"}).images) {
    EXPECT_FALSE(image.error);
    // The plain environment has no floor. So far down too little is above one.
    if (*image.spec.environment_name == "plain") continue;
    EXPECT_GT(image.spec.variables->values.model_place_m[2], -0.11);
  }
}

TEST_F(KeepTest, TheCameraKeepsItsDistanceAndStaysOutside) {
  const std::string positions =
      "camera.position_m={choice=[[0,0,0],[0.1,0,0.2],[0.3,0.1,0.3]],weights=[1,1,1]}";
  const std::vector<std::string> random = {"camera.set=\"random\"",
                                           "camera.count=8",
                                           positions,
                                           "camera.focus=\"distance\"",
                                           "camera.focus_distance_m=0.3",
                                           "camera.target=[0,0,0.001]"};
  auto near_ones = random;
  near_ones.push_back("camera.keep.clearance_m=0.01");
  for (const PlannedImage& image : plan_with(near_ones).images) {
    ASSERT_FALSE(image.error) << image.error->what();
    EXPECT_NE(image.spec.variables->values.position_m[0], 0) << image.spec.id;
  }
  auto far_ones = random;
  far_ones.push_back("camera.keep.clearance_m=0.25");
  const Plan far = plan_with(far_ones);
  for (const PlannedImage& image : far.images)
    EXPECT_EQ(image.spec.variables->values.position_m[0], 0.3) << image.spec.id;
  EXPECT_GT(far.drawn.rejected.at("clearance_m"), 0U);
}

// A thing's own size stays while its view is drawn again.
TEST_F(KeepTest, WhatAModelSharesIsDrawnOnce) {
  std::map<std::string, std::set<double>> sizes;
  int attempts = 0;
  for (const PlannedImage& image :
       plan_with({k_around, "camera.keep.in_frame=0.95", "models.size_m={uniform=[0.05,0.1]}"})
           .images) {
    sizes[*image.spec.model_name].insert(image.spec.variables->values.model_size_m);
    attempts += image.spec.variables->attempts;
  }
  EXPECT_GT(attempts, 0);
  for (const auto& [model, values] : sizes)
    EXPECT_EQ(values.size(), 1U) << model;
}

// What was found out is not looked for again, and gives the same.
TEST_F(KeepTest, AnotherPlanIsTheSame) {
  request.overrides = {k_sunk, k_around, "camera.keep.visible=0.5", "camera.keep.in_frame=0.8"};
  build();
  EXPECT_TRUE(stale().empty());
  const Plan again = plan(), anew = plan(Stamps::ignore);
  EXPECT_EQ(again.drawn.draws, anew.drawn.draws);
  EXPECT_EQ(again.drawn.rejected, anew.drawn.rejected);
  for (std::size_t i = 0; i < again.images.size(); ++i)
    EXPECT_EQ(again.images[i].keys.render, anew.images[i].keys.render);
}

}  // namespace
}  // namespace ds
