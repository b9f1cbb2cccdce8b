// SPDX-License-Identifier: Apache-2.0
// The measuring, against a tracer whose noise, bias and time follow laws that are known.
#include "builder/measure/accuracy.h"

#include "builder/measure/ladder.h"
#include "tests/builder/measure/pictures.h"
#include "tracer/base/error.h"
#include "tracer/kernels/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace ds {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;

/// Films of radiance 1 - 4^-depth, times 0.9 without a lens, with noise 0.5 / sqrt(spp); a picture
/// takes 0.25 s and 2 ms a sample of a pixel, half of that with fast arithmetic. The clock moves
/// only by tracing.
class KnownTracer : public SceneTracer {
 public:
  void set_scene(const Scene& scene) override { lights = scene.lights.size(); }
  Film trace(const Camera& camera, const EngineSettings& engine,
             const std::atomic<bool>& stop) override {
    if (stop) fail(ErrorKind::cancelled, "stopped");
    const double deep = engine.depth_total >= 16 ? 0 : std::pow(4.0, -engine.depth_total);
    const double mean = (1 - deep) * (camera.lens_radius_m > 0 ? 1 : 0.9);
    const double noise = 0.5 / std::sqrt(engine.spp);
    const double seconds = 0.25 + 0.002 * engine.spp * (engine.math == MathMode::fast ? 0.5 : 1.0);
    clock_ += seconds * (1 + slowing * ++pictures_);
    Film film = noisy_film(engine.width, static_cast<float>(mean), static_cast<float>(noise),
                           static_cast<unsigned>(engine.seed));
    film.relative_error = noise / mean;
    return film;
  }
  Film trace_plain(const Camera& camera, const EngineSettings& engine,
                   const std::atomic<bool>& stop) override {
    Film film = trace(camera, engine, stop);
    clock_ -= 0.0005 * engine.spp * (1 + slowing * pictures_);
    return film;
  }
  /// Samples of 2^24, then of 1, which a plain float sum of 2^24 loses.
  void trace_on(const Camera&, const EngineSettings& engine, FilmSums& sums,
                const std::atomic<bool>&) override {
    if (sums.empty()) sums = empty_film(engine.width, engine.height);
    for (std::uint32_t& spp : sums.tile_spp)
      spp = static_cast<std::uint32_t>(engine.spp);
    for (std::size_t tile = 0; tile < sums.tile_spp.size(); ++tile)
      for (std::size_t c = 0; c < 3; ++c) {
        std::ranges::fill(sums.row(tile, kernels::k_film_sum + c), 0x1p24f);
        std::ranges::fill(sums.row(tile, kernels::k_film_compensation + c),
                          static_cast<float>(engine.spp - 1));
      }
  }
  Geometry trace_geometry(const Camera&, int width, int height) override {
    clock_ += 1e-6 * width * height;
    const auto pixels = static_cast<std::size_t>(width * height);
    Geometry geometry{width, height, std::vector<std::uint8_t>(pixels, 255),
                      std::vector<float>(pixels, 1)};
    // A vertical edge at 30 % of the width.
    for (std::size_t i = 0; i < pixels; ++i)
      if (double(i % static_cast<std::size_t>(width)) + 0.5 > 0.3 * width) geometry.mask[i] = 0;
    return geometry;
  }
  std::string device() const override { return "known"; }
  double now() const override { return clock_; }
  double busy() const override { return clock_; }

  std::size_t lights = 0;
  double slowing = 0;  ///< what a picture takes more than the one before

 private:
  double clock_ = 0;
  int pictures_ = 0;
};

class AccuracyTest : public testing::Test {
 protected:
  Accuracy measure(const AccuracyOptions& options, const std::vector<std::string>& overrides) {
    const Recipe recipe = read_recipe(DS_SOURCE_DIR "/tests/data/tiny/recipe.toml", overrides);
    return measure_accuracy(
        recipe, inputs_, tracer_, options,
        [this](const std::string& what) { told_.push_back(what); }, stop_);
  }

  Database database_{std::filesystem::path()};
  Inputs inputs_{database_};
  KnownTracer tracer_;
  std::vector<std::string> told_;
  std::atomic<bool> stop_{false};
};

const std::vector<std::string> k_with_lens{"engine.width=64", "engine.height=64",
                                           "camera.lens_radius_m=0.001"};

TEST_F(AccuracyTest, FindsTheLawsOfErrorAndTime) {
  AccuracyOptions options;
  options.most_spp = 64;
  options.choices = false;
  const Accuracy accuracy = measure(options, k_with_lens);
  EXPECT_EQ(accuracy.device, "known");
  ASSERT_EQ(accuracy.pairs.size(), told_.size());
  ASSERT_EQ(accuracy.pairs.size(), 4U);  // two environments, two materials
  const double c = 0.5 / (1 - std::pow(4.0, -6));
  for (const PairAccuracy& pair : accuracy.pairs) {
    ASSERT_EQ(pair.ladder.size(), 7U);
    ASSERT_TRUE(pair.law.has_value());
    // 4096 pixels and 4 seeds: a rung's error is known to 0.55 %.
    EXPECT_NEAR(pair.law->line.slope, -0.5, 0.01);
    EXPECT_NEAR(pair.law->error(16), c / 4, 0.03 * c / 4);
    const Rung& rung = pair.ladder[4];
    EXPECT_EQ(rung.spp, 16);
    EXPECT_NEAR(rung.seconds.value, 0.25 + 0.002 * 16, 1e-9);
    EXPECT_NEAR(rung.estimate.value(), c / 4, 1e-6);
    const Interval error = rung.metrics.at(Metric::error);
    EXPECT_LT(error.low, error.value);
    EXPECT_LT(error.value, error.high);
    EXPECT_LT(error.high / error.low, 1.1);
    EXPECT_NEAR(pair.seconds.slope, 0.002, 1e-9);
    EXPECT_NEAR(pair.seconds.intercept, 0.25, 1e-9);
    // The reference's mean has 2 * 8 * 64 samples a pixel.
    EXPECT_NEAR(pair.reference_error, c / std::sqrt(1024.0), 0.05 * c / std::sqrt(1024.0));
    ASSERT_EQ(pair.targets.size(), 3U);
    EXPECT_EQ(pair.plain_sums_spp, 64);
    EXPECT_NEAR(pair.plain_sums, 63 / (0x1p24 + 63), 1e-12);
    EXPECT_EQ(pair.targets[1].error, 0.02);
    const double n = (c / 0.02) * (c / 0.02);
    EXPECT_NEAR(pair.targets[1].spp.value, n, 0.1 * n);
    EXPECT_NEAR(pair.targets[1].seconds.value, 0.25 + 0.002 * n, 0.15 * n * 0.002);
    EXPECT_TRUE(pair.targets[1].extrapolated);
  }
}

TEST_F(AccuracyTest, FindsWhatChoicesCost) {
  AccuracyOptions options;
  options.most_spp = 64;
  options.seeds = 2;
  const PairAccuracy pair = measure(options, k_with_lens).pairs.front();
  std::map<std::string, ChoiceCost> costs;
  for (const ChoiceCost& cost : pair.choices)
    costs[cost.choice.group + " " + cost.choice.name] = cost;
  // Half of 64 spp.
  EXPECT_NEAR(costs.at("math fast").time.value, (0.25 + 0.032) / (0.25 + 0.064), 1e-9);
  EXPECT_FALSE(costs.at("math fast").bias.has_value());
  EXPECT_NEAR(costs.at("sums plain").time.value, (0.25 + 0.048) / (0.25 + 0.064), 1e-9);
  EXPECT_FALSE(costs.at("sums plain").bias.has_value());
  EXPECT_NEAR(costs.at("effect lens").bias->value, 0.1, 1e-3);
  EXPECT_NEAR(costs.at("path depth 2").bias->value, 1.0 / 16, 1e-3);
  EXPECT_NEAR(costs.at("path depth 3").bias->value, 1.0 / 64, 1e-3);
  EXPECT_FALSE(costs.at("path depth 16").bias.has_value());
  EXPECT_NEAR(costs.at("path depth as the recipe").bias->value, std::pow(4.0, -6), 1e-4);
  EXPECT_NEAR(costs.at("effect lens").noise.value(), 1 / 0.9, 1e-6);
}

TEST_F(AccuracyTest, AMachineThatSlowsDownChangesNoChoicesCost) {
  tracer_.slowing = 0.01;
  AccuracyOptions options;
  options.most_spp = 64;
  options.seeds = 2;
  const PairAccuracy pair = measure(options, k_with_lens).pairs.front();
  ASSERT_GT(pair.choices.size(), 15U);
  for (const ChoiceCost& cost : pair.choices) {
    const bool is_fast = cost.choice.group == "math";
    const bool is_plain = cost.choice.group == "sums";
    const double expected = is_fast ? 0.282 / 0.314 : is_plain ? 0.298 / 0.314 : 1;
    // Between the first and the last of a choice's pictures the machine slows by 6 % at most.
    EXPECT_NEAR(cost.time.value, expected, 0.002) << cost.choice.group << " " << cost.choice.name;
    EXPECT_LE(cost.time.low, cost.time.value);
    EXPECT_LE(cost.time.value, cost.time.high);
  }
}

TEST_F(AccuracyTest, MasksOfOneRayMissWhatLiesBesideIt) {
  AccuracyOptions options;
  options.most_spp = 4;
  options.seeds = 2;
  options.choices = false;
  const PairAccuracy pair = measure(options, {}).pairs.front();
  ASSERT_EQ(pair.geometry.size(), 4U);
  EXPECT_EQ(pair.geometry[0].rays, 1);
  EXPECT_EQ(pair.geometry[3].rays, 64);
  // 32 pixels wide: the edge at 9.6 leaves 0.6 of one pixel in 32 to the model; its centre says 1.
  EXPECT_NEAR(pair.geometry[0].errors.mask_rms, 0.4 / std::sqrt(32.0), 0.03);
  EXPECT_EQ(pair.geometry[0].errors.mask_wrong, 0);
  EXPECT_LT(pair.geometry[3].errors.mask_rms, pair.geometry[0].errors.mask_rms);
  EXPECT_EQ(pair.geometry[0].errors.depth_rms, 0);
}

TEST_F(AccuracyTest, StopsWhenTold) {
  stop_ = true;
  try {
    measure({}, {});
    ADD_FAILURE() << "it measured on";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::cancelled);
  }
}

TEST(Ladder, EndsAtWhatWasAskedFor) {
  EXPECT_THAT(ladder_of(16), ElementsAre(1, 2, 4, 8, 16));
  EXPECT_THAT(ladder_of(20), ElementsAre(1, 2, 4, 8, 16, 20));
  EXPECT_THAT(ladder_of(1), ElementsAre(1));
}

PairAccuracy with_times(const std::vector<double>& seconds) {
  const std::vector<double> spp{1, 2, 4, 8, 16};
  PairAccuracy pair;
  pair.law = fit_power_law(spp, std::vector<double>{0.11, 0.065, 0.055, 0.033, 0.026});
  pair.seconds = fit_line(spp, seconds);
  find_targets(pair);
  return pair;
}

TEST(Targets, LieWithinTheirBounds) {
  // The last overhead is by chance so small that the line is below 0 at no samples.
  for (const std::vector<double>& seconds :
       {std::vector<double>{0.0011, 0.0021, 0.0038, 0.0082, 0.0159},
        std::vector<double>{0.0009, 0.0017, 0.0036, 0.0079, 0.0172}}) {
    const PairAccuracy pair = with_times(seconds);
    EXPECT_EQ(pair.no_targets, "");
    ASSERT_EQ(pair.targets.size(), k_target_errors.size());
    for (const Target& target : pair.targets)
      for (const Interval& interval : {target.spp, target.seconds}) {
        EXPECT_GE(interval.low, 0);
        EXPECT_LT(interval.low, interval.value);
        EXPECT_LT(interval.value, interval.high);
      }
    EXPECT_LT(pair.targets[0].seconds.value, pair.targets[1].seconds.value);
  }
}

TEST(Targets, AreNotToldWhereTheTimeOfASampleIsLostInTheNoise) {
  for (const std::vector<double>& seconds :
       {std::vector<double>{0.0036, 0.0035, 0.0034, 0.0031, 0.0024},     // falls
        std::vector<double>{0.0030, 0.0051, 0.0024, 0.0047, 0.0041}}) {  // anything
    const PairAccuracy pair = with_times(seconds);
    EXPECT_TRUE(pair.targets.empty());
    EXPECT_THAT(pair.no_targets, testing::HasSubstr("the time of a sample is lost"));
  }
}

TEST(Targets, AreNotToldWhereTheErrorIsLostInTheNoise) {
  PairAccuracy pair;
  find_targets(pair);
  EXPECT_THAT(pair.no_targets, testing::HasSubstr("lost in the reference's noise"));
  const std::vector<double> spp{1, 2, 4};
  pair.law = fit_power_law(spp, std::vector<double>{0.2, 0.3, 0.19});
  pair.seconds = fit_line(spp, std::vector<double>{1, 2, 4});
  find_targets(pair);
  EXPECT_TRUE(pair.targets.empty());
  EXPECT_THAT(pair.no_targets, testing::HasSubstr("the fall of its error is lost"));
}

TEST(RepresentativeImages, OneForEachPairWhateverTheOrder) {
  const Recipe recipe = read_recipe(DS_SOURCE_DIR "/tests/data/tiny/recipe.toml", {});
  std::vector<ImageSpec> images = expand(recipe);
  const std::vector<PairChoice> chosen = representative_images(images);
  ASSERT_EQ(chosen.size(), 4U);
  std::uint64_t total = 0;
  for (const PairChoice& choice : chosen)
    total += choice.images;
  EXPECT_EQ(total, images.size());
  std::reverse(images.begin(), images.end());
  const std::vector<PairChoice> again = representative_images(images);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    EXPECT_EQ(chosen[i].image.id, again[i].image.id);
    EXPECT_EQ(chosen[i].image.environment_name, again[i].image.environment_name);
  }
}

}  // namespace
}  // namespace ds
