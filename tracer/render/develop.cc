// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/develop.h"

#include "tracer/base/error.h"
#include "tracer/base/luminance.h"
#include "tracer/render/strict_math.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ds {
namespace {

double luminance_at(const float* rgb) {
  return luxcore_luminance(Vec3{rgb[0], rgb[1], rgb[2]});
}

std::size_t pixel_count(const Film& film) {
  const std::size_t count =
      static_cast<std::size_t>(film.width) * static_cast<std::size_t>(film.height);
  DS_ASSERT(film.width > 0 && film.height > 0 && film.rgb.size() == count * 3);
  return count;
}

double autolinear_scale(const Film& film, double gamma) {
  const std::size_t count = pixel_count(film);
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double y = luminance_at(film.rgb.data() + i * 3);
    if (y > 0 && std::isfinite(y)) sum += y;
  }
  const double mean = sum / static_cast<double>(count);
  return mean > 0 ? 1.25 / mean * strict_pow(118.0 / 255.0, gamma) : 1.0;
}

double reinhard02_scale(const Film& film) {
  const std::size_t count = pixel_count(film);
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double y = luminance_at(film.rgb.data() + i * 3);
    if (std::isfinite(y)) sum += strict_log(std::max(y, 1e-6));
  }
  return 0.1 / strict_exp(sum / static_cast<double>(count));
}

/// The factor on one pixel, given the picture's scale.
double pixel_factor(const float* rgb, const ToneMap& tone_map, double scale) {
  if (tone_map.kind != ToneMap::Kind::reinhard02) return scale;
  const double burn = tone_map.burn;
  const double inverse_burn2 = burn > 0 ? 1.0 / (burn * burn) : 1e5;
  const double y = luminance_at(rgb) * scale / double{tone_map.prescale};
  return scale * double{tone_map.postscale} * (1.0 + y * inverse_burn2) / (1.0 + y);
}

/// The least linear value of each level: level k begins where 255 v^(1 / gamma) = k - 1/2. One pow
/// a level instead of one a sample, and monotonic whatever the last bit of pow.
std::array<double, 255> level_starts(double gamma) {
  std::array<double, 255> starts;
  for (std::size_t k = 0; k < starts.size(); ++k)
    starts[k] = strict_pow((static_cast<double>(k) + 0.5) / 255.0, gamma);
  return starts;
}

/// NaN gives 0, as does all below 0.
std::uint8_t quantise(double linear, const std::array<double, 255>& starts) {
  if (!(linear > 0)) return 0;
  const auto above = std::upper_bound(starts.begin(), starts.end(), linear);
  return static_cast<std::uint8_t>(above - starts.begin());
}

/// Of ToneCurve's table: octaves below 1, and steps of equal width in each.
constexpr int k_curve_octaves = 30;
constexpr int k_curve_steps = 64;

}  // namespace

double tone_map_scale(const Film& film, const ToneMap& tone_map) {
  switch (tone_map.kind) {
    case ToneMap::Kind::linear:
      return double{tone_map.scale};
    case ToneMap::Kind::autolinear:
      return autolinear_scale(film, double{tone_map.gamma});
    case ToneMap::Kind::reinhard02:
      return reinhard02_scale(film);
  }
  DS_ASSERT(false);
  return 1;
}

ToneCurve::ToneCurve(const ToneMap& tone_map, double scale) : tone_map_(tone_map), scale_(scale) {
  DS_ASSERT(tone_map.gamma > 0);
  for (int i = 0; i <= k_curve_octaves * k_curve_steps; ++i) {
    const double linear = std::ldexp(1.0 + double(i % k_curve_steps) / k_curve_steps,
                                     i / k_curve_steps - k_curve_octaves);
    table_.push_back(strict_pow(linear, 1.0 / double{tone_map.gamma}));
  }
}

/// Straight between the table's entries, and from the darkest to 0.
double ToneCurve::power(double linear) const {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  int exponent = 0;
  const double fraction = std::frexp(linear, &exponent);  // in [1/2, 1), exact
  if (exponent <= -k_curve_octaves) return table_[0] * std::ldexp(linear, k_curve_octaves);
  const double step = (2 * fraction - 1) * k_curve_steps;
  const auto whole = static_cast<std::size_t>(step);
  const std::size_t i =
      static_cast<std::size_t>(exponent - 1 + k_curve_octaves) * k_curve_steps + whole;
  return table_[i] + (table_[i + 1] - table_[i]) * (step - static_cast<double>(whole));
}

std::array<double, 3> ToneCurve::at(const std::array<float, 3>& rgb) const {
  const double factor = pixel_factor(rgb.data(), tone_map_, scale_);
  std::array<double, 3> developed{};
  for (std::size_t c = 0; c < 3; ++c)
    developed[c] = power(double{rgb[c]} * factor);
  return developed;
}

BytePicture develop(const Film& film, const ToneMap& tone_map) {
  return develop_at(film, tone_map, tone_map_scale(film, tone_map));
}

BytePicture develop_at(const Film& film, const ToneMap& tone_map, double scale) {
  DS_ASSERT(tone_map.gamma > 0);
  const std::size_t count = pixel_count(film);
  const std::array<double, 255> starts = level_starts(double{tone_map.gamma});
  BytePicture picture{film.width, film.height, 3, std::vector<std::uint8_t>(count * 3)};
  for (std::size_t i = 0; i < count; ++i) {
    const float* rgb = film.rgb.data() + i * 3;
    const double factor = pixel_factor(rgb, tone_map, scale);
    for (std::size_t c = 0; c < 3; ++c)
      picture.pixels[i * 3 + c] = quantise(double{rgb[c]} * factor, starts);
  }
  return picture;
}

std::uint64_t clipped_pixels(const Film& film, const ToneMap& tone_map) {
  return clipped_pixels_at(film, tone_map, tone_map_scale(film, tone_map));
}

std::uint64_t clipped_pixels_at(const Film& film, const ToneMap& tone_map, double scale) {
  constexpr double k_clipped = 1.05;
  std::uint64_t clipped = 0;
  for (std::size_t i = 0; i < pixel_count(film); ++i) {
    const float* rgb = film.rgb.data() + i * 3;
    const double least = std::min({double{rgb[0]}, double{rgb[1]}, double{rgb[2]}});
    clipped += least * pixel_factor(rgb, tone_map, scale) > k_clipped ? 1U : 0U;
  }
  return clipped;
}

}  // namespace ds
