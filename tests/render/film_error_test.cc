// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/film_error.h"

#include "tests/render/pictures.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace ds {
namespace {

TEST(FilmErrorTest, closed_forms) {
  // One grey pixel of 1 whose even samples sum to 4.5 and odd ones to 3.5: halves' means 1.125 and
  // 0.875, standard error of their mean half their difference.
  const std::vector<float> grey = {1, 1, 1};
  EXPECT_NEAR(*relative_error(grey, std::vector<float>{1.0f}, 8), 0.125, 1e-12);
  // Samples that all agree have no error, also where the even half has one more.
  EXPECT_NEAR(*relative_error(grey, std::vector<float>{0.0f}, 8), 0.0, 1e-12);
  EXPECT_NEAR(*relative_error(grey, std::vector<float>{1.0f}, 7), 0.0, 1e-6);
  EXPECT_EQ(relative_error(std::vector<float>{0, 0, 0}, std::vector<float>{0.0f}, 8), 0.0);
  EXPECT_EQ(relative_error(grey, std::vector<float>{1.0f}, 1), std::nullopt);
}

double luminance(const Film& film, std::size_t i) {
  return 0.2126 * double{film.rgb[3 * i]} + 0.7152 * double{film.rgb[3 * i + 1]} +
         0.0722 * double{film.rgb[3 * i + 2]};
}

/// Mean squared error of the luminance relative to the squared mean luminance of `truth`.
double true_square(const Film& film, const std::vector<double>& truth) {
  double mean = 0;
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    mean += truth[i];
    sum += (luminance(film, i) - truth[i]) * (luminance(film, i) - truth[i]);
  }
  const double pixels = static_cast<double>(truth.size());
  return sum / pixels / ((mean / pixels) * (mean / pixels));
}

/// Over many small pictures the estimate's mean square is that of the error against a picture of
/// 256 times the samples.
TEST(FilmErrorTest, estimates_the_error_against_a_converged_picture) {
  for (pictures::Picture picture : pictures::all_effects()) {
    SCOPED_TRACE(picture.name);
    picture.engine.spp = 16 * 256;
    picture.engine.seed = pictures::wide_seed(1000);
    picture.engine.width = picture.engine.height = 16;
    const Film converged = pictures::trace(picture);
    std::vector<double> truth;
    for (std::size_t i = 0; i < 256; ++i)
      truth.push_back(luminance(converged, i));
    picture.engine.spp = 16;
    double estimated = 0;
    double measured = 0;
    constexpr int count = 40;
    for (int i = 0; i < count; ++i) {
      picture.engine.seed = pictures::wide_seed(static_cast<std::uint64_t>(i));
      const Film film = pictures::trace(picture);
      estimated += *film.relative_error * *film.relative_error;
      measured += true_square(film, truth);
    }
    // 40 pictures of 256 pixels: 2 % of standard error for well-behaved pixels. The few bright ones
    // of caustics carry more, hence 15 %.
    EXPECT_NEAR(estimated / measured, 1.0, 0.15);
  }
}

}  // namespace
}  // namespace ds
