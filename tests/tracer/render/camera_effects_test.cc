// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/camera_effects.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ds {
namespace {

Film grey(int width, int height, float value) {
  Film film;
  film.width = width;
  film.height = height;
  film.rgb.assign(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value);
  return film;
}

ToneMap linear_map() {
  ToneMap map;
  map.kind = ToneMap::Kind::linear;
  return map;
}

TEST(CameraEffects, NoneChangeNothing) {
  const Film film = grey(5, 4, 0.3F);
  EXPECT_EQ(with_effects(film, 1, {}).rgb, film.rgb);
  EXPECT_EQ(develop(film, linear_map(), {}).picture.pixels, develop(film, linear_map()).pixels);
  EXPECT_EQ(canonical_effects({}), "");
}

TEST(CameraEffects, ExposureIsAPowerOfTwoThatNoToneMapTakesBack) {
  const Film film = grey(4, 4, 0.1F);
  EXPECT_NEAR(with_effects(film, 1, {.exposure_ev = 1}).rgb[7], 0.2F, 1e-7F);
  EXPECT_NEAR(with_effects(film, 1, {.exposure_ev = -0.5}).rgb[7], 0.1 / std::sqrt(2.0), 1e-7);
  ToneMap autolinear;
  autolinear.kind = ToneMap::Kind::autolinear;
  const DevelopedPicture brighter = develop(film, autolinear, {.exposure_ev = 1});
  EXPECT_GT(brighter.picture.pixels[0], develop(film, autolinear).pixels[0]);
  EXPECT_EQ(brighter.scale, tone_map_scale(film, autolinear));
  // 0.6 at 2^1 is over what a picture shows, and so clipped.
  EXPECT_EQ(develop(grey(2, 2, 0.6F), linear_map(), {.exposure_ev = 1}).clipped, 4U);
}

TEST(CameraEffects, VignettingTakesItsShareFromTheCorners) {
  const Film film = with_effects(grey(101, 101, 1), 1, {.vignetting = 0.4});
  const auto at = [&](int x, int y) { return film.rgb[3 * static_cast<std::size_t>(101 * y + x)]; };
  EXPECT_EQ(at(50, 50), 1);
  // The corner pixel's middle lies 50 of 50.5 from the middle on both axes.
  EXPECT_NEAR(at(0, 0), 1 - 0.4 * (50 * 50) / (50.5 * 50.5), 1e-6);
  EXPECT_NEAR(at(50, 0), 1 - 0.4 * (50 * 50) / (2 * 50.5 * 50.5), 1e-6);
  EXPECT_EQ(at(0, 100), at(100, 0));
}

TEST(CameraEffects, ABlurSpreadsAPointAsAGaussianOfItsDeviation) {
  Film film = grey(41, 41, 0);
  const std::size_t middle = 3 * (41 * 20 + 20);
  film.rgb[middle] = 1;
  const Film blurred = with_effects(film, 1, {.blur_px = 1.5});
  double sum = 0, second = 0;
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 41; ++x) {
      const double value = blurred.rgb[3 * static_cast<std::size_t>(41 * y + x)];
      sum += value;
      second += value * (x - 20) * (x - 20);
      EXPECT_NEAR(value, blurred.rgb[3 * static_cast<std::size_t>(41 * x + y)],
                  4e-9);  // rounded twice, at up to 0.07
    }
  EXPECT_NEAR(sum, 1, 1e-6);
  // Cut off at three deviations, rounded up: a little less than 1.5^2.
  EXPECT_NEAR(second, 2.25, 0.05);
  EXPECT_EQ(blurred.rgb[middle + 1], 0);
  // An even picture stays as it is, to its edges.
  for (const float value : with_effects(grey(9, 7, 0.5F), 1, {.blur_px = 2}).rgb)
    EXPECT_NEAR(value, 0.5F, 1e-6F);
}

TEST(CameraEffects, NoiseHasTheVarianceItSays) {
  for (const double value : {0.25, 0.64}) {
    const Film film = grey(200, 200, static_cast<float>(value / 2));
    const double noise = 0.02;
    const Film noisy = with_effects(film, 2, {.noise = noise, .seed = 7});
    double sum = 0, squares = 0, neighbours = 0, before = 0;
    for (const float rgb : noisy.rgb) {
      const double off = 2 * double{rgb} - value;
      sum += off;
      squares += off * off;
      neighbours += off * before;
      before = off;
    }
    const double count = static_cast<double>(noisy.rgb.size());
    const double wanted = noise * noise * (value + 0.01), deviation = std::sqrt(wanted);
    // Four deviations of the estimates: of a mean, of a variance and of a correlation.
    EXPECT_LT(std::fabs(sum / count), 4 * deviation / std::sqrt(count));
    EXPECT_LT(std::fabs(squares / count / wanted - 1), 4 * std::sqrt(2 / count));
    EXPECT_LT(std::fabs(neighbours / count / wanted), 4 / std::sqrt(count));
  }
}

TEST(CameraEffects, NoiseIsOfSeedAndPlaceAlone) {
  const Film wide = with_effects(grey(20, 10, 0.5F), 1, {.noise = 0.1, .seed = 7});
  const Film narrow = with_effects(grey(10, 10, 0.5F), 1, {.noise = 0.1, .seed = 7});
  for (std::size_t y = 0; y < 10; ++y)
    for (std::size_t x = 0; x < 30; ++x)
      EXPECT_EQ(wide.rgb[60 * y + x], narrow.rgb[30 * y + x]);
  EXPECT_NE(with_effects(grey(20, 10, 0.5F), 1, {.noise = 0.1, .seed = 8}).rgb, wide.rgb);
  for (const float value : with_effects(grey(50, 50, 0), 1, {.noise = 0.5}).rgb)
    EXPECT_GE(value, 0);
}

TEST(CameraEffects, AJpegLosesMoreTheWorseItIs) {
  Film film = grey(64, 48, 0);
  for (std::size_t i = 0; i < film.rgb.size(); ++i)
    film.rgb[i] = static_cast<float>((i * 7919) % 101) / 101;
  const BytePicture exact = develop(film, linear_map());
  double before = 0;
  for (const int quality : {100, 80, 30}) {
    const BytePicture picture = develop(film, linear_map(), {.jpeg_quality = quality}).picture;
    ASSERT_EQ(picture.pixels.size(), exact.pixels.size());
    double squares = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); ++i)
      squares += std::pow(int{exact.pixels[i]} - int{picture.pixels[i]}, 2);
    EXPECT_GT(squares, before) << quality;
    before = squares;
  }
}

TEST(CameraEffects, TheirTextNamesWhatIsDone) {
  EXPECT_EQ(canonical_effects({.exposure_ev = 0.5, .seed = 7}),
            "camera.effects_version = 1\ncamera.exposure_ev = 0x1p-1\n");
  EXPECT_EQ(canonical_effects({.noise = 0.5, .jpeg_quality = 90, .seed = 7}),
            "camera.effects_version = 1\ncamera.noise = 0x1p-1\ncamera.noise_seed = 7\n"
            "camera.jpeg_quality = 90\n");
}

}  // namespace
}  // namespace ds
