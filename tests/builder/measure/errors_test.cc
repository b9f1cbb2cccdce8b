// SPDX-License-Identifier: Apache-2.0
// Errors between pictures: closed forms, and values that other people's programs gave for the same
// pictures.
#include "builder/measure/flip.h"
#include "builder/measure/image_errors.h"
#include "builder/measure/ssim.h"
#include "tests/builder/measure/pictures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ds {
namespace {

Film constant_film(int side, float value) {
  return noisy_film(side, value, 0, 1);
}

BytePicture constant_picture(int side, std::uint8_t value) {
  return {side, side, 3,
          std::vector<std::uint8_t>(static_cast<std::size_t>(side * side * 3), value)};
}

TEST(LinearErrors, OfAConstantOffsetAreItsSquare) {
  const LinearErrors errors =
      linear_errors(constant_film(8, 2.2f), {constant_film(8, 2), constant_film(8, 2)});
  EXPECT_NEAR(errors.mean_square, 0.01, 1e-6);
  EXPECT_NEAR(errors.rel_mse, 0.04 / (4 + 0.04), 1e-6);
  EXPECT_NEAR(errors.rel_mse_trimmed, errors.rel_mse, 1e-12);
}

TEST(LinearErrors, TheReferencesNoiseIsNoErrorOfThePicture) {
  // 250,000 pixels: the standard error of the mean square is 0.3 % of 0.01.
  const float noise = 0.1f;
  const LinearErrors errors = linear_errors(
      noisy_film(500, 1, noise, 1), {noisy_film(500, 1, noise, 2), noisy_film(500, 1, noise, 3)});
  EXPECT_NEAR(errors.mean_square, 0.01, 5 * 0.01 * std::sqrt(5.0 / 250000));
  const LinearErrors none = linear_errors(
      constant_film(500, 1), {noisy_film(500, 1, noise, 2), noisy_film(500, 1, noise, 3)});
  EXPECT_NEAR(none.mean_square, 0, 5 * 0.01 / 500);
}

TEST(LinearErrors, OneFireflyIsTrimmed) {
  Film film = constant_film(20, 1);
  film.rgb[30] = film.rgb[31] = film.rgb[32] = 101;
  const LinearErrors errors = linear_errors(film, {constant_film(20, 1), constant_film(20, 1)});
  EXPECT_NEAR(errors.rel_mse, 1e4 / 1.01 / 400, 1e-2);
  EXPECT_EQ(errors.rel_mse_trimmed, 0);
}

TEST(LinearErrors, OfABlackReferenceAreNone) {
  EXPECT_EQ(linear_errors(constant_film(4, 1), {constant_film(4, 0), constant_film(4, 0)}).rel_mse,
            0);
}

TEST(LinearErrors, BiasIsSeenThroughNoise) {
  const BiasSquare square =
      relative_bias_square(noisy_film(500, 1.02f, 0.1f, 1), noisy_film(500, 1.02f, 0.1f, 2),
                           {noisy_film(500, 1, 0.1f, 3), noisy_film(500, 1, 0.1f, 4)});
  // Products of two differences of deviation 0.14 each, over 250,000 pixels.
  EXPECT_NEAR(square.value, 0.0004, 5 * 0.02 / 500);
  EXPECT_NEAR(square.standard_error, 0.02 / 500, 0.02 * 0.02 / 500);
}

TEST(PictureErrors, AreThoseOfScikitImage) {
  const BytePicture reference = wavy_picture();
  const BytePicture test = spoilt_picture();
  const double mean_square = picture_mean_square(test, reference, reference);
  EXPECT_NEAR(mean_square, 849.1253472222222, 1e-9);
  // skimage.metrics 0.26: peak_signal_noise_ratio; structural_similarity of luma with
  // gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=255.
  EXPECT_NEAR(psnr_db(mean_square).value(), 18.841085556784726, 1e-12);
  EXPECT_NEAR(ssim(reference, test).value(), 0.7687502607178841, 1e-9);
}

TEST(PictureErrors, OfEqualPictures) {
  const BytePicture picture = wavy_picture();
  EXPECT_FALSE(psnr_db(picture_mean_square(picture, picture, picture)).has_value());
  EXPECT_NEAR(ssim(picture, picture).value(), 1, 1e-12);
  EXPECT_EQ(flip(picture, picture), 0);
}

TEST(PictureErrors, ATinyPictureHoldsNoWindowOfSsim) {
  EXPECT_FALSE(ssim(constant_picture(10, 0), constant_picture(10, 0)).has_value());
  EXPECT_TRUE(ssim(constant_picture(11, 0), constant_picture(11, 0)).has_value());
}

TEST(Flip, IsThatOfItsAuthors) {
  // NVIDIA's flip-evaluator 1.7: evaluate(reference, test, "LDR"), which is in single precision.
  EXPECT_NEAR(flip(wavy_picture(), spoilt_picture()), 0.2714971601963043, 2e-6);
  EXPECT_NEAR(flip(constant_picture(20, 0), constant_picture(20, 255)), 0.9673861861228943, 1e-5);
}

}  // namespace
}  // namespace ds
