// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/pixel_filter.h"

#include "tracer/kernels/layout.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace ds {
namespace {

constexpr std::size_t k_side = 40;
constexpr PixelRect k_all{0, 0, k_side, k_side};

/// Sets one quarter of a pixel: a grey mean, and what even and odd samples have beside it.
void set_quarter(FilmSums& film, std::size_t x, std::size_t y, std::size_t q, float count,
                 float mean, float half = 0) {
  float* pixel = film.planes.data() + film.place(x, y);
  const auto plane = [&](std::size_t number) -> float& {
    return pixel[(q * kernels::k_film_quarter + number) * kernels::k_tile_pixels];
  };
  for (std::size_t c = 0; c < 3; ++c) {
    plane(kernels::k_film_sum + c) = count * mean;
    plane(kernels::k_film_halves + c) = count * half;
  }
  plane(kernels::k_film_count) = count;
  plane(kernels::k_film_count_halves) = 0;
}

/// `value(x, y, q)`: the grey mean of a quarter of two samples.
template <typename Value>
FilmSums film_of_quarters(const Value& value) {
  FilmSums film = empty_film(k_side, k_side);
  for (std::size_t y = 0; y < k_side; ++y)
    for (std::size_t x = 0; x < k_side; ++x)
      for (std::size_t q = 0; q < 4; ++q)
        set_quarter(film, x, y, q, 2, value(x, y, q));
  return film;
}

/// Variance of a pixel over that of the mean of its own samples, where all have the same.
double noise(const PixelFilter& filter) {
  double squares = 0;
  for (const double weight : filter.weights())
    squares += weight * weight;
  return 2 * squares * (2 * squares);
}

TEST(PixelFilter, UpToOnePixelItIsABox) {
  for (const float width : {0.0f, 0.5f, 1.0f}) {
    const PixelFilter box(width);
    EXPECT_EQ(box.reach(), 0u);
    ASSERT_EQ(box.weights().size(), 2u);
    EXPECT_EQ(box.weights()[0], 0.5);
    ASSERT_EQ(box.shares().size(), 1u);
    EXPECT_EQ(box.shares()[0], 1);
    EXPECT_EQ(box.correlation(), 1);
  }
}

TEST(PixelFilter, HasTheWindowsWidth) {
  // The window's variance over its squared width, by a fine sum.
  double variance = 0, area = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = (i + 0.5) / 20000;
    const auto c = [&](int k) { return std::cos(2 * M_PI * k * x); };
    const double w = 0.35875 - 0.48829 * c(1) + 0.14128 * c(2) - 0.01168 * c(3);
    variance += w * (x - 0.5) * (x - 0.5);
    area += w;
  }
  variance /= area;
  for (const float width : {1.5f, 3.0f, 4.0f, 7.3f, 16.0f}) {
    const PixelFilter filter(width);
    const auto weights = filter.weights();
    EXPECT_EQ(filter.reach(), static_cast<std::size_t>(std::ceil(double{width} / 2 - 0.5)));
    ASSERT_EQ(weights.size(), 2 * (2 * filter.reach() + 1));
    double sum = 0, moment = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      EXPECT_GT(weights[i], -1e-7);
      EXPECT_NEAR(weights[i], weights[weights.size() - 1 - i], 1e-6);
      const double middle = (double(i) + 0.5) / 2 - double(filter.reach()) - 0.5;
      sum += weights[i];
      moment += weights[i] * middle * middle;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    // Gathering into bins of h adds h^2 / 12 to the variance (Sheppard) where the window is smooth
    // over a bin; of 1.5 pixels each bin has a third of it.
    const double sheppard = 0.25 / 12;
    EXPECT_NEAR(moment, variance * double{width} * double{width} + sheppard,
                width < 2 ? 0.2 * moment : 1e-3 * moment);
  }
}

TEST(PixelFilter, NoiseAndCorrelationAreThoseOfWhiteNoise) {
  for (const float width : {3.0f, 4.0f}) {
    const PixelFilter filter(width);
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    double own = 0, squares = 0, beside = 0, diagonal = 0;
    std::size_t count = 0;
    for (int film = 0; film < 40; ++film) {
      const FilmSums sums =
          film_of_quarters([&](std::size_t, std::size_t, std::size_t) { return normal(random); });
      const auto box = filtered(sums, PixelFilter(0), k_all);
      const auto pixels = filtered(sums, filter, k_all);
      for (std::size_t y = 2; y < k_side - 3; ++y)
        for (std::size_t x = 2; x < k_side - 3; ++x) {
          const auto at = [&](std::size_t u, std::size_t v) {
            return double{pixels[v * k_side + u].mean[0]};
          };
          const double b = double{box[y * k_side + x].mean[0]};
          own += b * b;
          squares += at(x, y) * at(x, y);
          beside += at(x, y) * at(x + 1, y);
          diagonal += at(x, y) * at(x + 1, y + 1);
          ++count;
        }
    }
    // 49,000 pixels: 0.7 % of standard error of each sum of squares.
    EXPECT_NEAR(own / static_cast<double>(count), 0.25, 0.006);
    EXPECT_NEAR(squares / own, noise(filter), 0.03 * noise(filter));
    const double r = beside / squares, d = diagonal / squares;
    EXPECT_NEAR(d, r * r, 0.02);
    // Of the pixels further away only the width of 4 knows any, and little.
    EXPECT_NEAR(1 + 4 * r * r + 4 * d * d, filter.correlation(), 0.05);
  }
  EXPECT_NEAR(1 / noise(PixelFilter(3)), 2.5, 0.01);
}

TEST(PixelFilter, SharesSumToOne) {
  const PixelFilter filter(4);
  const auto shares = filter.shares();
  ASSERT_EQ(shares.size(), 5u);
  EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1, 1e-12);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(shares[i], shares[4 - i], 1e-6);
    EXPECT_GT(shares[i + 1], shares[i]);
  }
}

/// Quarters without samples, of other counts, and the picture's edges leave an even picture even.
TEST(PixelFilter, AnEvenPictureStaysEven) {
  FilmSums film = film_of_quarters([](std::size_t, std::size_t, std::size_t) { return 0.3f; });
  for (std::size_t i = 0; i < k_side; ++i) {
    set_quarter(film, i, 7, i % 4, 0, 0);
    set_quarter(film, 11, i, i % 4, 6, 0.3f);
  }
  for (const float width : {0.0f, 3.0f, 16.0f})
    for (const PixelEstimate& pixel : filtered(film, PixelFilter(width), k_all)) {
      EXPECT_NEAR(pixel.mean[1], 0.3f, 1e-7f);
      EXPECT_NEAR(pixel.half[1], 0, 1e-7f);
    }
}

TEST(PixelFilter, AFilmWithoutSamplesIsBlack) {
  for (const PixelEstimate& pixel : filtered(empty_film(k_side, k_side), PixelFilter(3), k_all)) {
    EXPECT_EQ(pixel.mean[0], 0);
    EXPECT_EQ(pixel.half[0], 0);
  }
}

/// What a quarter holds is dealt out to the pixels around, none lost, by the weights' products.
TEST(PixelFilter, AQuarterIsDealtOut) {
  const PixelFilter filter(3);
  const auto weights = filter.weights();
  for (std::size_t q = 0; q < 4; ++q) {
    const FilmSums film = film_of_quarters([&](std::size_t x, std::size_t y, std::size_t quarter) {
      return x == 9 && y == 14 && quarter == q ? 1.0f : 0.0f;
    });
    const auto pixels = filtered(film, filter, k_all);
    double sum = 0;
    for (const PixelEstimate& pixel : pixels)
      sum += double{pixel.mean[2]};
    EXPECT_NEAR(sum, 0.25, 1e-6);
    for (std::size_t v = 0; v < 3; ++v)
      for (std::size_t u = 0; u < 3; ++u)
        // Pixel (8 + u, 13 + v) has it 1 - u to the right and 1 - v below.
        EXPECT_NEAR(double{pixels[(13 + v) * k_side + 8 + u].mean[2]},
                    weights[2 * (2 - u) + q % 2] * weights[2 * (2 - v) + q / 2], 1e-7);
  }
}

TEST(PixelFilter, APartOfThePictureIsAsInTheWhole) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> numbers;
  const FilmSums film =
      film_of_quarters([&](std::size_t, std::size_t, std::size_t) { return numbers(random); });
  const PixelFilter filter(5);
  const auto whole = filtered(film, filter, k_all);
  for (const PixelRect rect : {PixelRect{0, 0, 4, 4}, {36, 36, 40, 40}, {12, 16, 16, 20}}) {
    const auto part = filtered(film, filter, rect);
    std::size_t i = 0;
    for (std::size_t y = rect.y0; y < rect.y1; ++y)
      for (std::size_t x = rect.x0; x < rect.x1; ++x, ++i)
        EXPECT_EQ(part[i].mean, whole[y * k_side + x].mean) << x << " " << y;
    EXPECT_EQ(part.size(), i);
  }
}

/// Even samples 0.5 + 0.1, odd ones 0.5 - 0.1.
TEST(PixelFilter, HalvesAreHalfTheDifferenceOfEvenAndOdd) {
  FilmSums film = empty_film(k_side, k_side);
  for (std::size_t y = 0; y < k_side; ++y)
    for (std::size_t x = 0; x < k_side; ++x)
      for (std::size_t q = 0; q < 4; ++q)
        set_quarter(film, x, y, q, 8, 0.5f, 0.1f);
  for (const PixelEstimate& pixel : filtered(film, PixelFilter(3), k_all)) {
    EXPECT_NEAR(pixel.mean[0], 0.5f, 1e-7f);
    EXPECT_NEAR(pixel.half[0], 0.1f, 1e-7f);
  }
}

}  // namespace
}  // namespace ds
