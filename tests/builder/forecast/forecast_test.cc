// SPDX-License-Identifier: Apache-2.0
#include "builder/forecast/budget.h"
#include "tests/builder/tiny_dataset.h"
#include "tracer/render/film.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace ds {
namespace {

using testing::ElementsAre;
using testing::Key;

Probe probe(double image, double sample, double error_at_one) {
  Probe p;
  p.low_spp = 4;
  p.high_spp = 16;
  p.scene_seconds = 0.5;
  p.image_seconds = image;
  p.sample_seconds = sample;
  p.low_error = error_at_one / 2;
  p.high_error = error_at_one / 4;
  p.bytes["image"] = {1000, 900};
  return p;
}

ProbedWork work(std::uint64_t images, std::vector<Probe> probes) {
  ProbedWork w;
  w.work.environment = "attic";
  w.work.material = "clay";
  w.work.images = w.work.trace = images;
  w.work.scenes = images / 10;
  w.work.files["image"] = images;
  w.probes = std::move(probes);
  return w;
}

TEST(Forecast, TimeIsScenesImagesAndSamples) {
  const Forecast f = forecast({work(100, {probe(0.1, 0.01, 0.8)})}, {std::nullopt, 64});
  EXPECT_NEAR(f.seconds.value, 10 * 0.5 + 100 * (0.1 + 64 * 0.01), 1e-9);
  ASSERT_EQ(f.pairs.size(), 1U);
  EXPECT_EQ(f.pairs[0].spp, 64);
  EXPECT_NEAR(f.pairs[0].error, 0.1, 1e-12);
  EXPECT_NEAR(f.pairs[0].seconds_an_image, 0.74, 1e-12);
}

TEST(Forecast, WhatIsDoneCostsNothing) {
  ProbedWork done = work(100, {probe(0.1, 0.01, 0.8)});
  done.work.trace = done.work.remake = done.work.scenes = 0;
  done.work.files.clear();
  const Forecast none = forecast({done}, {std::nullopt, 64});
  EXPECT_EQ(none.seconds.value, 0);
  EXPECT_EQ(none.seconds.high, 0);
  EXPECT_EQ(none.bytes.value, 0);
  done.work.remake = 50;
  const Forecast remade = forecast({done}, {std::nullopt, 64});
  EXPECT_NEAR(remade.seconds.value, 5, 1e-9);
  EXPECT_NEAR(remade.pairs[0].seconds_an_image, 0.1, 1e-12);
  EXPECT_EQ(remade.pairs[0].traced_spp, 0);
}

TEST(Forecast, KeptFilmsTakeTheMissingSamplesOnly) {
  ProbedWork w = work(100, {probe(0.1, 0.01, 0.8)});
  w.work.kept = {{64, 100}};
  Forecast f = forecast({w}, {std::nullopt, 65});
  EXPECT_NEAR(f.seconds.value, 10 * 0.5 + 100 * (0.1 + 0.01), 1e-9);
  EXPECT_EQ(f.pairs[0].spp, 65);
  EXPECT_NEAR(f.pairs[0].traced_spp, 1, 1e-12);
  EXPECT_NEAR(f.pairs[0].seconds_an_image, 0.11, 1e-12);
  EXPECT_NEAR(f.pairs[0].error, 0.8 / std::sqrt(65), 1e-12) << "of the whole film";
  // Half of the films, and of these half with other samples.
  w.work.kept = {{16, 25}, {64, 25}};
  f = forecast({w}, {std::nullopt, 65});
  EXPECT_NEAR(f.pairs[0].traced_spp, (50 * 65 + 25 * 49 + 25 * 1) / 100.0, 1e-12);
  // To an error of 0.16 it takes 25 samples: one with more was for a smaller error.
  f = forecast({w}, {0.16, 0});
  EXPECT_NEAR(f.pairs[0].traced_spp, (75 * 25 + 25 * 9) / 100.0, 1e-9);
}

TEST(Forecast, IntervalIsThatOfASampledTotal) {
  // Two of 100 images took 1 s and 3 s: mean 2, relative deviation sqrt(0.5).
  ProbedWork w = work(100, {probe(1, 0, 0.8), probe(3, 0, 0.8)});
  w.work.scenes = 0;
  const Forecast f = forecast({w}, {std::nullopt, 1});
  const double deviation = std::sqrt(0.5) * 2 * 100 / std::sqrt(2.0) * std::sqrt(1 - 0.02);
  EXPECT_NEAR(f.seconds.value, 200, 1e-9);
  EXPECT_NEAR(f.seconds.high - 200, std::hypot(12.706 * deviation, k_drift * 200), 1e-6);
  EXPECT_EQ(f.seconds.low, 0);
  // Both of two images: only the drift is left.
  w = work(2, {probe(1, 0, 0.8), probe(3, 0, 0.8)});
  const Forecast all = forecast({w}, {std::nullopt, 1});
  EXPECT_NEAR(all.seconds.high - all.seconds.value, k_drift * all.seconds.value, 1e-9);
}

TEST(Forecast, AnErrorTellsTheSamplesOfEachImage) {
  // c / sqrt(n) = 0.05: n = 256 for c = 0.8, 1024 for c = 1.6.
  const Forecast f = forecast({work(10, {probe(0, 0.01, 0.8), probe(0, 0.01, 1.6)})}, {0.05, 0});
  EXPECT_NEAR(f.pairs[0].spp, 640, 1e-6);
  EXPECT_NEAR(f.pairs[0].error, 0.05, 1e-12);
  EXPECT_NEAR(f.seconds.value, 0.5 + 10 * 6.4, 1e-6);
}

TEST(Forecast, EngineErrorTakesItsOwnSamples) {
  // Half the error of as many samples for all pixels, each half as dear again.
  Probe p = probe(0.1, 0.01, 0.8);
  p.target = {64, 0.05, 0.015};
  const Forecast by_error = forecast({work(10, {p})}, {0.025, 0});
  EXPECT_NEAR(by_error.pairs[0].spp, 256, 1e-6);
  EXPECT_NEAR(by_error.pairs[0].error, 0.025, 1e-12);
  EXPECT_NEAR(by_error.seconds.value, 0.5 + 10 * (0.1 + 256 * 0.015), 1e-6);
  // Never fewer than its first step, nor more than max_spp.
  EXPECT_EQ(forecast({work(10, {p})}, {0.5, 0}).pairs[0].spp, 16);
  const Forecast capped = forecast({work(10, {p})}, {0.001, 0, 1024});
  EXPECT_EQ(capped.pairs[0].spp, 1024);
  EXPECT_NEAR(capped.pairs[0].error, 0.4 / 32, 1e-12);
  EXPECT_EQ(capped.pairs[0].capped, 1);
  EXPECT_EQ(by_error.pairs[0].capped, 0);
  Probe clean = p;
  clean.target->error = 0.001;
  EXPECT_NEAR(forecast({work(10, {p, clean})}, {0.001, 0, 1024}).pairs[0].capped, 0.5, 1e-12);
  // Without an error it is not asked.
  EXPECT_NEAR(forecast({work(10, {p})}, {std::nullopt, 64}).seconds.value, 0.5 + 10 * 0.74, 1e-9);
}

TEST(Forecast, AnUncertainSlopeCountsWithTheDistance) {
  // Slopes of -0.5 and -0.6: a deviation of 0.0707, and of 0.05 for their mean, -0.55.
  Probe steep = probe(0, 0.01, 0.8);
  steep.low_error = *steep.high_error * std::pow(4, 0.6);
  ProbedWork w = work(2, {probe(0, 0.01, 0.8), steep});
  w.work.scenes = 0;
  // Both images were probed: nothing scatters but the slopes. At 16 samples the error is 0.2.
  const auto half = [&](double error) {
    const Interval seconds = forecast({w}, {error, 0}).seconds;
    const double other = k_drift * seconds.value;
    const double whole = seconds.high - seconds.value;
    return std::sqrt(std::max(0.0, whole * whole - other * other));
  };
  EXPECT_NEAR(half(0.2), 0, 1e-6);
  const double n = 16 * std::pow(0.2 / 0.05, 1 / 0.55);
  EXPECT_NEAR(half(0.05), 12.706 * 0.05 * 2 * 0.01 * n * std::log(n / 16) / 0.55, 1e-3);
}

TEST(Forecast, ABudgetBuysTheErrorWhoseTimeItIs) {
  const std::vector<ProbedWork> all{work(10, {probe(0.2, 0.01, 0.8), probe(0.2, 0.02, 0.9)}),
                                    work(20, {probe(0.1, 0.03, 1.6), probe(0.1, 0.02, 1.5)})};
  const std::optional<Bought> bought = error_for(all, 3600, k_most_spp);
  ASSERT_TRUE(bought.has_value());
  EXPECT_FALSE(bought->capped);
  const Interval* error = &bought->error;
  EXPECT_NEAR(forecast(all, {error->value, 1}).seconds.value, 3600, 0.1);
  EXPECT_NEAR(forecast(all, {error->high, 1}).seconds.high, 3600, 0.1);
  EXPECT_LT(error->low, error->value);
  EXPECT_LT(error->value, error->high);
  // Four times as long halves the error of what has little else to do.
  EXPECT_NEAR(error_for(all, 4 * 3600, k_most_spp)->error.value, error->value / 2,
              0.01 * error->value);
  EXPECT_FALSE(error_for(all, 1, k_most_spp).has_value());
  EXPECT_FALSE(error_for({}, 3600, k_most_spp).has_value());
}

TEST(Forecast, ABudgetBuysNoMoreThanMaxSppAllows) {
  // c / sqrt(n): with 64 samples all are at or below 0.2, in a few seconds.
  ProbedWork done = work(10, {probe(0.1, 0.01, 4)});
  done.work.trace = 0;
  const std::vector<ProbedWork> all{work(10, {probe(0.1, 0.01, 0.8), probe(0.1, 0.01, 1.6)}), done};
  const std::optional<Bought> bought = error_for(all, 3600, 64);
  ASSERT_TRUE(bought.has_value());
  EXPECT_TRUE(bought->capped);
  for (const double error : {bought->error.value, bought->error.low, bought->error.high})
    EXPECT_NEAR(error, 0.2, 1e-9);
  const Forecast f = forecast(all, {bought->error.value, 0, 64});
  EXPECT_EQ(f.pairs[0].capped, 0) << "every picture reaches it";
  EXPECT_LT(f.seconds.value, 100);
  EXPECT_NEAR(most_spp_for(all, 0.1), 256, 1e-6);
  // A time that buys less is not bounded by it.
  const std::optional<Bought> less = error_for(all, 4, 64);
  ASSERT_TRUE(less.has_value());
  EXPECT_FALSE(less->capped);
  EXPECT_GT(less->error.value, 0.2);
  EXPECT_NEAR(forecast(all, {less->error.value, 0, 64}).seconds.value, 4, 1e-3);
}

TEST(Forecast, SizesFollowTheirTrend) {
  // 100 bytes less for each fourfold number of samples: 50 a doubling.
  const Forecast f = forecast({work(10, {probe(0, 0, 0.8)})}, {std::nullopt, 64});
  EXPECT_NEAR(f.bytes.value, 10 * 800, 1e-9);
  EXPECT_NEAR(f.bytes_by_kind.at("image"), 8000, 1e-9);
  // Never below half of what was seen.
  EXPECT_NEAR(forecast({work(10, {probe(0, 0, 0.8)})}, {std::nullopt, 1 << 20}).bytes.value, 4500,
              1e-9);
}

TEST(Forecast, SlopesAreHeldToWhatIsMet) {
  Probe odd = probe(0, 0.01, 0.8);
  odd.high_error = *odd.low_error * 1.1;  // a firefly in the longer picture
  const auto law = error_laws({odd}, false).front();
  ASSERT_TRUE(law.has_value());
  EXPECT_NEAR(law->slope, -1.0 / 3, 1e-12);
  EXPECT_NEAR(law->error(16), *odd.high_error, 1e-12);
  odd.high_error.reset();
  EXPECT_FALSE(error_laws({odd}, false).front().has_value());
}

TEST(Duration, IsReadByItsUnits) {
  EXPECT_EQ(parse_duration("8h"), 28800);
  EXPECT_EQ(parse_duration("90m"), 5400);
  EXPECT_EQ(parse_duration("45s"), 45);
  EXPECT_EQ(parse_duration("1h30m"), 5400);
  EXPECT_EQ(parse_duration("2.5h"), 9000);
  for (const char* wrong : {"", "8", "h", "8 h", "-1h", "1m1h", "1h1h", "0s", "1..5h", "8hours",
                            "inf", "infh", "1e3s", "nans"})
    EXPECT_FALSE(parse_duration(wrong).has_value()) << wrong;
}

TEST(Calibration, ProbesAreKeptWhole) {
  Probe p = probe(0.1, 0.2, 0.7);
  p.low_error.reset();
  p.target = {64, 0.05, 0.015};
  const auto read = probe_from_json(to_json_text(p));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->image_seconds, p.image_seconds);
  EXPECT_EQ(read->sample_seconds, p.sample_seconds);
  EXPECT_EQ(read->high_error, p.high_error);
  EXPECT_FALSE(read->low_error.has_value());
  EXPECT_EQ(read->bytes.at("image").low, 1000);
  EXPECT_EQ(read->target.value().error, 0.05);
  for (const char* wrong : {"", "{", "[]", "{\"version\":1}", "{\"version\":\"1\"}", "null"})
    EXPECT_FALSE(probe_from_json(wrong).has_value()) << wrong;
}

/// A fake whose errors are known, with a clock that only its work moves: 0.5 s for another scene,
/// 0.03 s for a mask, 2 ms for a sample of every pixel.
class TimedRenderer : public FakeRenderer {
 public:
  using FakeRenderer::FakeRenderer;
  Film trace(const ImageSpec& image, FilmSums* kept,
             const std::function<void(const TraceProgress&)>& progress,
             const std::atomic<bool>& stop) override {
    load(image);
    Film film = FakeRenderer::trace(image, kept, progress, stop);
    const auto& target = image.engine.target;
    const int spp = target ? target->max_spp : image.engine.spp;
    clock += (target ? 0.003 : 0.002) * spp;
    film.relative_error = 0.8 / std::sqrt(spp);
    *kept = empty_film(film.width, film.height);
    kept->tile_spp.assign(kept->tile_spp.size(), static_cast<std::uint32_t>(spp));
    // A plane more has values than with few samples; no more follow.
    std::fill_n(kept->row(0, 0).begin(), 1, 1.0f);
    if (spp > 8) std::fill_n(kept->row(0, 1).begin(), 1, 1.0f);
    if (target) {
      film.facts.samples = static_cast<std::uint64_t>(film.width * film.height * spp);
      film.facts.developed_high = 0.4 / std::sqrt(spp);
    }
    return film;
  }
  std::vector<Plane> trace_planes(const ImageSpec& image,
                                  const std::vector<const PlaneType*>& types) override {
    load(image);
    clock += 0.03;
    return FakeRenderer::trace_planes(image, types);
  }

  double clock = 0;

 private:
  void load(const ImageSpec& image) {
    const std::string wanted = *image.model_name + *image.material_name + *image.environment_name;
    if (wanted != loaded_) clock += 0.5;
    loaded_ = wanted;
  }
  std::string loaded_;
};

class CalibrationTest : public TinyDataset {
 protected:
  Recipe recipe(const std::vector<std::string>& overrides = {}) const {
    return read_recipe(recipe_folder() / "recipe.toml", overrides);
  }
  Calibration calibrated(const std::vector<std::string>& overrides, bool again = false,
                         bool by_error = false) {
    const Recipe recipe = this->recipe(overrides);
    Database database{std::filesystem::path()};
    Inputs inputs(database);
    TimedRenderer renderer(calls);
    return calibrate(recipe, inputs, renderer, CalibrationCache(scratch() / "cache"),
                     {again, by_error}, scratch() / "work",
                     {[](const std::string&) {}, [&renderer] { return renderer.clock; }, stop});
  }
};

TEST_F(CalibrationTest, MeasuresWhatABuildTakesAndLeavesNothingBehind) {
  const Calibration c = calibrated({});
  EXPECT_EQ(c.device, "fake");
  ASSERT_EQ(c.pairs.size(), 4U);
  EXPECT_FALSE(std::filesystem::exists(scratch() / "work"));
  for (const std::vector<Probe>& probes : c.probes)
    for (const Probe& p : probes) {
      EXPECT_NEAR(p.sample_seconds, 0.002, 1e-9);
      EXPECT_NEAR(p.image_seconds, 0.03, 1e-9);
      EXPECT_NEAR(p.scene_seconds, 0.5, 1e-9);
      EXPECT_NEAR(p.high_error.value(), 0.8 / std::sqrt(p.high_spp), 1e-12);
      EXPECT_GT(p.bytes.at("image").high, 0);
      EXPECT_GT(p.bytes.at("mask").high, 0);
      EXPECT_GT(p.bytes.at("film").high, 0);
    }
}

TEST_F(CalibrationTest, WithoutAPictureThereAreNoSamples) {
  const std::vector<std::string> geometry{"outputs.image=false", "outputs.depth=exr",
                                          "engine.error=0.05"};
  for (const bool by_error : {false, true}) {
    const Calibration c = calibrated(geometry, false, by_error);
    EXPECT_EQ(c.measured > 0, !by_error) << "an error is of pictures";
    ASSERT_EQ(c.pairs.size(), 4U);
    for (const std::vector<Probe>& probes : c.probes)
      for (const Probe& p : probes) {
        EXPECT_EQ(p.sample_seconds, 0);
        EXPECT_NEAR(p.image_seconds, 0.03, 1e-9);
        EXPECT_NEAR(p.scene_seconds, 0.5, 1e-9);
        EXPECT_FALSE(p.low_error || p.high_error || p.target);
        EXPECT_THAT(p.bytes, ElementsAre(Key("depth"), Key("mask")));
      }
  }
  request.overrides = geometry;
  const Forecast f =
      forecast(join(work_of(plan(), recipe()), calibrated(geometry)), {std::nullopt, 0});
  EXPECT_NEAR(f.seconds.value, 4 * 0.5 + 8 * 0.03, 1e-9);
  EXPECT_THAT(f.bytes_by_kind, ElementsAre(Key("depth"), Key("mask")));
  EXPECT_TRUE(std::isfinite(f.bytes.value));
  EXPECT_EQ(f.pairs.front().spp, 0);
  EXPECT_EQ(f.pairs.front().error, 0);
  EXPECT_TRUE(calls.traced.empty());
}

TEST_F(CalibrationTest, KeptSumsAreForecast) {
  const std::vector<std::string> keep{"engine.keep_sums=true", "engine.spp=1024"};
  EXPECT_GT(calibrated({}).measured, 0U);
  const Calibration c = calibrated(keep);
  EXPECT_GT(c.measured, 0U) << "what was kept knows nothing of the sums";
  request.overrides = keep;
  const Forecast f = forecast(join(work_of(plan(), recipe(keep)), c), {std::nullopt, 1024});
  // 64 tiles' samples, and two planes of 1024 pixels; some hundred bytes say so.
  EXPECT_NEAR(f.bytes_by_kind.at("film_sums"), 8 * (64 * 4 + 2 * 1024 * 4 + 100), 8 * 50);
}

TEST_F(CalibrationTest, LeavesNothingBehindWhereItFails) {
  calls.fails_on = expand(recipe()).back().id;
  EXPECT_THROW(calibrated({}), Error);
  EXPECT_FALSE(std::filesystem::exists(scratch() / "work"));
  calls.fails_on.clear();
  stop = true;
  EXPECT_THROW(calibrated({}), Error);
  EXPECT_FALSE(std::filesystem::exists(scratch() / "work"));
}

TEST_F(CalibrationTest, IsMeasuredOnceForEachDeviceAndProgram) {
  const std::size_t probes = calibrated({}).measured;
  EXPECT_GT(probes, 0U);
  EXPECT_EQ(calibrated({}).measured, 0U);
  EXPECT_EQ(calibrated({"engine.spp=512"}).measured, 0U) << "the samples are no part of it";
  EXPECT_EQ(calibrated({}, true).measured, probes);
  EXPECT_EQ(calibrated({"engine.depth_total=3"}).measured, probes);
  edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.75 0.1 0.1");
  const std::size_t red = calibrated({}).measured;
  EXPECT_GT(red, 0U);
  EXPECT_LT(red, probes);
}

TEST_F(CalibrationTest, ProbesEngineErrorWhereItIsAskedFor) {
  const std::size_t probes = calibrated({}).measured;
  const Calibration c = calibrated({}, false, true);
  EXPECT_EQ(c.measured, probes) << "what was kept knows nothing of it";
  for (const std::vector<Probe>& of_pair : c.probes)
    for (const Probe& p : of_pair) {
      ASSERT_TRUE(p.target.has_value());
      EXPECT_EQ(p.target->spp, k_target_probe_spp);
      EXPECT_NEAR(p.target->error, 0.4 / std::sqrt(k_target_probe_spp), 1e-12);
      EXPECT_NEAR(p.target->sample_seconds, 0.003, 1e-9);
      EXPECT_NEAR(p.sample_seconds, 0.002, 1e-9);
    }
  EXPECT_EQ(calibrated({}, false, true).measured, 0U);
  EXPECT_EQ(calibrated({}).measured, 0U);
}

TEST_F(CalibrationTest, WithoutMaxSppItsDefaultHolds) {
  EXPECT_EQ(recipe({"engine.error=0.05"}).engine.target.value().max_spp, ErrorTarget{}.max_spp);
}

TEST_F(CalibrationTest, WorkIsWhatThePlanLeaves) {
  const std::vector<PairWork> all = work_of(plan(), recipe());
  ASSERT_EQ(all.size(), 4U);
  std::uint64_t images = 0;
  for (const PairWork& pair : all) {
    EXPECT_EQ(pair.trace, pair.images);
    EXPECT_EQ(pair.files.at("image"), pair.images);
    EXPECT_EQ(pair.files.at("film"), pair.images);
    images += pair.images;
  }
  EXPECT_EQ(images, k_images);
  build();
  for (const PairWork& pair : work_of(plan(), recipe())) {
    EXPECT_EQ(pair.trace + pair.remake + pair.scenes, 0U);
    EXPECT_TRUE(pair.files.empty());
  }
  edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.75 0.1 0.1");
  for (const PairWork& pair : work_of(plan(), recipe({"outputs.keep_film=false"}))) {
    EXPECT_EQ(pair.trace, pair.material == "red" ? pair.images : 0);
    EXPECT_EQ(pair.files.count("mask"), 0U) << "a colour moves no mask";
    EXPECT_EQ(pair.files.count("film"), 0U);
  }
}

TEST_F(CalibrationTest, PairsAndTheirWorkComeTogether) {
  const Calibration c = calibrated({});
  const std::vector<ProbedWork> joined = join(work_of(plan(), recipe()), c);
  ASSERT_EQ(joined.size(), 4U);
  const Forecast f = forecast(joined, {std::nullopt, 100});
  double scenes = 0;
  for (const ProbedWork& pair : joined)
    scenes += static_cast<double>(pair.work.scenes);
  EXPECT_NEAR(f.seconds.value, 0.5 * scenes + 8 * (0.03 + 100 * 0.002), 1e-9);
  for (const PairForecast& pair : f.pairs)
    EXPECT_NEAR(pair.error, 0.08, 1e-9);
}

}  // namespace
}  // namespace ds
