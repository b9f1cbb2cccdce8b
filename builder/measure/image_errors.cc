// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/image_errors.h"

#include "builder/measure/fit.h"
#include "tracer/base/error.h"
#include "tracer/base/luminance.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace ds {
namespace {

/// Share of the pixels that rel_mse_trimmed leaves out.
constexpr double k_trimmed = 0.001;
/// Of the mean luminance squared: keeps a black pixel's error finite.
constexpr double k_relative_floor = 0.01;

double luminance_at(const Film& film, std::size_t pixel) {
  return luminance(Vec3{film.rgb[3 * pixel], film.rgb[3 * pixel + 1], film.rgb[3 * pixel + 2]});
}

std::size_t pixel_count(const Film& film) {
  return film.rgb.size() / 3;
}

void check_sizes(const Film& x, const Reference& reference) {
  DS_ASSERT(!x.rgb.empty());
  DS_ASSERT(x.rgb.size() == reference.a.rgb.size() && x.rgb.size() == reference.b.rgb.size());
}

double mean_luminance(const Reference& reference) {
  return (mean_luminance(reference.a) + mean_luminance(reference.b)) / 2;
}

/// One pixel's share of relMSE, a mean over its channels.
double pixel_rel_mse(const Film& film, const Reference& reference, std::size_t pixel,
                     double floor) {
  double sum = 0;
  for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
    const double x = double{film.rgb[i]};
    const double a = double{reference.a.rgb[i]};
    const double b = double{reference.b.rgb[i]};
    const double r = (a + b) / 2;
    sum += (x - a) * (x - b) / (r * r + floor);
  }
  return sum / 3;
}

}  // namespace

double mean_luminance(const Film& film) {
  double sum = 0;
  for (std::size_t i = 0; i < pixel_count(film); ++i)
    sum += luminance_at(film, i);
  return sum / static_cast<double>(pixel_count(film));
}

LinearErrors linear_errors(const Film& film, const Reference& reference) {
  check_sizes(film, reference);
  const double mean = mean_luminance(reference);
  if (mean <= 0) return {};
  const double floor = k_relative_floor * mean * mean;
  LinearErrors errors;
  std::vector<double> pixels(pixel_count(film));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double x = luminance_at(film, i);
    errors.mean_square += (x - luminance_at(reference.a, i)) * (x - luminance_at(reference.b, i));
    pixels[i] = pixel_rel_mse(film, reference, i, floor);
  }
  const double count = static_cast<double>(pixels.size());
  errors.mean_square /= count * mean * mean;
  errors.rel_mse = std::accumulate(pixels.begin(), pixels.end(), 0.0) / count;
  const auto trimmed =
      std::min(pixels.size() - 1, static_cast<std::size_t>(std::ceil(k_trimmed * count)));
  std::sort(pixels.begin(), pixels.end());
  const auto kept = pixels.size() - trimmed;
  errors.rel_mse_trimmed =
      std::accumulate(pixels.begin(), pixels.begin() + static_cast<std::ptrdiff_t>(kept), 0.0) /
      static_cast<double>(kept);
  return errors;
}

double picture_mean_square(const BytePicture& picture, const BytePicture& a, const BytePicture& b) {
  DS_ASSERT(!picture.pixels.empty());
  DS_ASSERT(picture.pixels.size() == a.pixels.size() && a.pixels.size() == b.pixels.size());
  double sum = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    sum += (picture.pixels[i] - a.pixels[i]) * (picture.pixels[i] - b.pixels[i]);
  return sum / static_cast<double>(picture.pixels.size());
}

std::optional<double> psnr_db(double mean_square) {
  if (mean_square <= 0) return std::nullopt;
  return 10 * std::log10(255.0 * 255.0 / mean_square);
}

BiasSquare relative_bias_square(const Film& x1, const Film& x2, const Reference& reference) {
  check_sizes(x1, reference);
  check_sizes(x2, reference);
  const double mean = mean_luminance(reference);
  if (mean <= 0) return {};
  std::vector<double> products(pixel_count(x1));
  for (std::size_t i = 0; i < products.size(); ++i)
    products[i] = (luminance_at(x1, i) - luminance_at(reference.a, i)) *
                  (luminance_at(x2, i) - luminance_at(reference.b, i)) / (mean * mean);
  return {mean_of(products),
          deviation_of(products) / std::sqrt(static_cast<double>(products.size()))};
}

}  // namespace ds
