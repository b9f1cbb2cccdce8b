// SPDX-License-Identifier: Apache-2.0
// What is not added to a film as it is, is counted by kind, and nothing else changes.
#include "tests/render/pictures.h"
#include "tracer/device/opencl.h"
#include "tracer/device/program_text.h"
#include "tracer/render/film.h"
#include "tracer/render/pixel_filter.h"
#include "tracer/render/view.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace ds {
namespace {

constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float k_infinity = std::numeric_limits<float>::infinity();

/// Adds samples given to a tile's pixels, by the function that trace_paths adds its own by.
constexpr const char* k_add_given = R"cl(
__kernel void add_given(const __global float* restrict samples, const __global uint* restrict words,
                        const __global ViewData* restrict view_data, __global float* restrict film) {
  const ViewData view = *view_data;
  const uint count = words[0];
  PixelQueue queue = pixel_queue(words + 1, (uint)get_global_id(0));
  Pixels pixels;
  Sums sums;
  clear_sums(&sums, film, &view);
  mask busy = change_pixels(&pixels, &sums, &queue, &view, (mask)(-1));
  while (any_lane(busy)) {
    for (uint i = 0u; i < count; ++i) {
      const real3 radiance =
          vec((real)(samples[3u * i]), (real)(samples[3u * i + 1u]), (real)(samples[3u * i + 2u]));
      add_samples(&sums, busy, (natural)(i), (natural)(2u), radiance);
    }
    busy = change_pixels(&pixels, &sums, &queue, &view, busy);
  }
}
)cl";

/// A film of 8x7 pixels, each of which got these samples.
Film film_of_samples(const std::vector<Vec3>& samples, MathMode math, int lanes, float limit = 0) {
  EngineSettings engine;
  engine.width = 8;
  engine.height = 7;
  engine.outlier_limit = limit;
  FilmSums sums = empty_film(engine.width, engine.height);
  const kernels::ViewData view = view_data(Camera{}, engine);
  std::vector<float> given;
  for (const Vec3 v : samples)
    given.insert(given.end(), {v.x, v.y, v.z});
  const Device device("");
  const Program program =
      device.build(path_program_text(all_effects()) + k_add_given,
                   fmt::format("{} -DDS_LANES={}",
                               math == MathMode::strict ? k_strict_options : k_fast_options, lanes),
                   DS_TEST_PROGRAMS);
  Kernel kernel = device.kernel(program, "add_given");
  const Buffer film = device.upload(sums.planes);
  kernel.set(0, device.upload(given));
  // Four tiles, two a work-item.
  const auto count = static_cast<std::uint32_t>(samples.size());
  kernel.set(1, device.upload(std::vector<std::uint32_t>{count, 32, 4,              //
                                                         0, 0, count, 1, 0, count,  //
                                                         2, 0, count, 3, 0, count}));
  kernel.set(2, device.upload(std::as_bytes(std::span(&view, 1))));
  kernel.set(3, film);
  device.run(kernel, 0, 2, 1);
  device.read(film, std::as_writable_bytes(std::span(sums.planes)));
  std::fill(sums.tile_spp.begin(), sums.tile_spp.end(), static_cast<std::uint32_t>(samples.size()));
  return film_of(sums, PixelFilter(0));
}

class FilmCounts : public testing::TestWithParam<std::tuple<MathMode, int>> {
 protected:
  static Film film(const std::vector<Vec3>& samples, float limit = 0) {
    return film_of_samples(samples, std::get<0>(GetParam()), std::get<1>(GetParam()), limit);
  }
  static constexpr std::uint64_t k_pixels = 56;
};

TEST_P(FilmCounts, SamplesThatCannotBeAddedAreCountedByKindAndBlack) {
  const Film f = film({{1, k_nan, 1},
                       {k_infinity, 1, k_nan},
                       {-1, -k_nan, 1},
                       {1, 1, k_infinity},
                       {-1, 2e30f, 1},
                       {1, -k_infinity, 1},
                       {3.4e38f, 0, 0},
                       {1, 1, -1e-30f},
                       {8, 16, 24},
                       {-2, 5, 5}});
  EXPECT_EQ(f.facts.nan_samples, 3 * k_pixels);
  EXPECT_EQ(f.facts.infinite_samples, 4 * k_pixels);
  EXPECT_EQ(f.facts.negative_samples, 2 * k_pixels);
  EXPECT_EQ(f.facts.outlier_samples, 0u);
  EXPECT_EQ(f.rejected_samples, 9 * k_pixels);
  EXPECT_EQ(f.facts.samples, 10 * k_pixels);
  for (std::size_t i = 0; i < f.rgb.size(); i += 3) {
    EXPECT_EQ(f.rgb[i], 0.8f);
    EXPECT_EQ(f.rgb[i + 1], 1.6f);
    EXPECT_EQ(f.rgb[i + 2], 2.4f);
    EXPECT_EQ(f.halves[i], 0.8f) << "its number is even";
  }
}

TEST_P(FilmCounts, GoodSamplesAreNotCounted) {
  const Film f = film({{0, 0, 0}, {1, 2, 3}, {-0.0f, 1e30f, 1e-40f}, {1e-30f, 0, 1e10f}});
  EXPECT_EQ(f.rejected_samples, 0u);
  EXPECT_EQ(f.facts.outlier_samples, 0u);
}

TEST_P(FilmCounts, OutliersAreScaledDownAndWhatTheyLoseIsReported) {
  const Film f = film({{8, 2, 4}, {2, 2, 2}, {-8, 9, 9}, {0, 0, 0}}, 2);
  EXPECT_EQ(f.facts.outlier_samples, k_pixels);
  EXPECT_EQ(f.facts.negative_samples, k_pixels);
  // (8, 2, 4) becomes (2, 0.5, 1).
  EXPECT_EQ(f.rgb[0], 1);
  EXPECT_EQ(f.rgb[1], 0.625f);
  EXPECT_EQ(f.rgb[2], 0.75f);
  const double bright = 0.2126 * 8 + 0.7152 * 2 + 0.0722 * 4;
  EXPECT_NEAR(f.facts.removed_energy, 0.75 * bright / (bright + 2), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Math, FilmCounts,
                         testing::Combine(testing::Values(MathMode::strict, MathMode::fast),
                                          testing::Values(1, 8)),
                         [](const auto& run) {
                           return std::string(std::get<0>(run.param) == MathMode::strict ? "strict"
                                                                                         : "fast") +
                                  std::to_string(std::get<1>(run.param));
                         });

TEST(Outliers, ALimitThatNoSampleReachesChangesNoBit) {
  for (pictures::Picture picture : pictures::all_effects()) {
    const Film off = pictures::trace(picture);
    picture.engine.outlier_limit = 1e30f;
    const Film on = pictures::trace(picture);
    EXPECT_EQ(pictures::film_hash(on), pictures::film_hash(off)) << picture.name;
    EXPECT_EQ(on.facts, off.facts);
    EXPECT_EQ(off.facts.removed_energy, 0);
  }
}

/// What is kept and what is reported as removed add up to the picture without a limit.
TEST(Outliers, RemovedEnergyIsWhatTheMeanLost) {
  for (pictures::Picture picture : pictures::all_effects()) {
    const auto mean = [](const Film& film) {
      double sum = 0;
      for (std::size_t i = 0; i < film.rgb.size(); i += 3)
        sum += 0.2126 * double{film.rgb[i]} + 0.7152 * double{film.rgb[i + 1]} +
               0.0722 * double{film.rgb[i + 2]};
      return sum;
    };
    picture.engine.filter_width = 0;  // every sample counts the same for the mean
    const double all = mean(pictures::trace(picture));
    picture.engine.outlier_limit = 3;
    const Film film = pictures::trace(picture);
    // Of one light or material, which may throw none far, there need not be any.
    const bool throws_far =
        !picture.name.starts_with("light-") && !picture.name.starts_with("material-");
    EXPECT_TRUE(film.facts.outlier_samples > 0 || !throws_far) << picture.name;
    EXPECT_NEAR(film.facts.removed_energy, 1 - mean(film) / all, 1e-5) << picture.name;
  }
}

/// Lanes and tiles share no counter.
TEST(Outliers, CountsDoNotDependOnLanes) {
  pictures::Picture picture = pictures::all_effects().back();
  picture.engine.outlier_limit = 3;
  const Film usual = pictures::trace(picture);
  for (const int lanes : {1, 4, 16}) {
    TracerOptions options = pictures::tracer_options();
    options.lanes = lanes;
    const Film film = pictures::trace(picture, options);
    EXPECT_EQ(film.facts, usual.facts) << lanes;
    EXPECT_EQ(pictures::film_hash(film), pictures::film_hash(usual)) << lanes;
  }
}

}  // namespace
}  // namespace ds
