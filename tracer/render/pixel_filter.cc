// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/pixel_filter.h"

#include "tracer/base/error.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/kernels/layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace ds {
namespace {

/// Integral from 0 to x of the Blackman-Harris window over [0, 1] (Harris 1978, 4-term, -92 dB).
double window_integral(double x) {
  // The kernels' sine, not libm's: its bits are the same everywhere, and they are in every pixel.
  const auto sine = [&](int k) {
    return double{kernels::sin_cos_turns(static_cast<float>(k * x)).sin};
  };
  constexpr double turn = 2 * 3.14159265358979323846;
  return 0.35875 * x - 0.48829 / turn * sine(1) + 0.14128 / (2 * turn) * sine(2) -
         0.01168 / (3 * turn) * sine(3);
}

std::size_t reach_of(float width) {
  return width > 1 ? static_cast<std::size_t>(std::ceil((double{width} - 1) / 2)) : 0;
}

std::vector<double> weights_of(float width, std::size_t reach) {
  if (reach == 0) return {0.5, 0.5};
  const auto until = [&](std::size_t half) {
    const double x = double(half) / 2 - double(reach) - 0.5;  // from the pixel's centre
    return window_integral(std::clamp(x / double{width} + 0.5, 0.0, 1.0));
  };
  std::vector<double> weights(2 * (2 * reach + 1));
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] = until(i + 1) - until(i);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights)
    weight /= sum;
  return weights;
}

/// What quarters are averaged to: r, g, b of all samples, of the even ones, of the odd ones; then
/// the weight that each of the three had.
constexpr std::size_t k_means = 12;
constexpr std::size_t k_even = 3, k_odd = 6, k_weights = 9;
using Means = std::array<double, k_means>;

void add(Means& to, double weight, const Means& from) {
  for (std::size_t i = 0; i < k_means; ++i)
    to[i] += weight * from[i];
}

/// The means of one quarter of a pixel; `values`: of its planes, one every k_tile_pixels floats.
Means quarter_means(const float* values) {
  const auto plane = [&](std::size_t number) {
    return double{values[number * kernels::k_tile_pixels]};
  };
  const double count = plane(kernels::k_film_count);
  const double even = (count + plane(kernels::k_film_count_halves)) / 2;
  const double odd = count - even;
  const auto inverse = [](double n) { return n > 0 ? 1 / n : 0.0; };
  const double per_sample = inverse(count), per_even = inverse(even), per_odd = inverse(odd);
  Means means;
  for (std::size_t c = 0; c < 3; ++c) {
    const double sum = plane(kernels::k_film_sum + c) + plane(kernels::k_film_compensation + c);
    const double halves = plane(kernels::k_film_halves + c);
    means[c] = sum * per_sample;
    means[k_even + c] = (sum + halves) / 2 * per_even;
    means[k_odd + c] = (sum - halves) / 2 * per_odd;
  }
  means[k_weights] = count > 0 ? 1 : 0;
  means[k_weights + 1] = even > 0 ? 1 : 0;
  means[k_weights + 2] = odd > 0 ? 1 : 0;
  return means;
}

/// The quarters of a rectangle of pixels as rows of half a pixel's height.
class Quarters {
 public:
  Quarters(const FilmSums& film, const PixelRect& rect)
      : rect_(rect), means_(4 * (rect.x1 - rect.x0) * (rect.y1 - rect.y0)) {
    for (std::size_t y = rect.y0; y < rect.y1; ++y)
      for (std::size_t x = rect.x0; x < rect.x1; ++x) {
        const float* pixel = film.planes.data() + film.place(x, y);
        for (std::size_t q = 0; q < 4; ++q)
          means_[2 * (y - rect.y0) * columns() + q / 2 * columns() + 2 * (x - rect.x0) + q % 2] =
              quarter_means(pixel + q * kernels::k_film_quarter * kernels::k_tile_pixels);
      }
  }
  std::size_t columns() const { return 2 * (rect_.x1 - rect_.x0); }
  /// `y`: in half pixels from the picture's top.
  const Means* row(std::size_t y) const { return means_.data() + (y - 2 * rect_.y0) * columns(); }

 private:
  PixelRect rect_;
  std::vector<Means> means_;
};

/// Calls visit(weight, number) for the half pixels under the filter of pixel `at` that lie in
/// [first, last) pixels.
template <typename Visit>
void visit_halves(const PixelFilter& filter, std::size_t at, std::size_t first, std::size_t last,
                  const Visit& visit) {
  const std::span<const double> weights = filter.weights();
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const std::size_t half = 2 * at + i;  // as far to the right as the filter reaches
    if (half < 2 * (first + filter.reach()) || half >= 2 * (last + filter.reach())) continue;
    visit(weights[i], half - 2 * filter.reach());
  }
}

PixelEstimate estimate_of(const Means& sum) {
  PixelEstimate estimate;
  const double all = sum[k_weights], even = sum[k_weights + 1], odd = sum[k_weights + 2];
  if (!(all > 0)) return estimate;
  for (std::size_t c = 0; c < 3; ++c) {
    estimate.mean[c] = static_cast<float>(sum[c] / all);
    if (even > 0 && odd > 0)
      estimate.half[c] = static_cast<float>((sum[k_even + c] / even - sum[k_odd + c] / odd) / 2);
  }
  return estimate;
}

}  // namespace

PixelFilter::PixelFilter(float width)
    : reach_(reach_of(width)), weights_(weights_of(width, reach_)) {
  DS_ASSERT(width >= 0 && width <= 16);
  double squares = 0;
  for (const double weight : weights_)
    squares += weight * weight;
  for (std::size_t i = 0; i < weights_.size(); i += 2)
    shares_.push_back((weights_[i] * weights_[i] + weights_[i + 1] * weights_[i + 1]) / squares);
}

double PixelFilter::correlation() const {
  std::vector<double> products(2 * reach_ + 1, 0.0);  // of weights so many pixels apart
  for (std::size_t away = 0; away < products.size(); ++away)
    for (std::size_t i = 2 * away; i < weights_.size(); ++i)
      products[away] += weights_[i] * weights_[i - 2 * away];
  double sum = 1;
  for (std::size_t away = 1; away < products.size(); ++away)
    sum += 2 * (products[away] / products[0]) * (products[away] / products[0]);
  return sum * sum;
}

std::vector<PixelEstimate> filtered(const FilmSums& film, const PixelFilter& filter,
                                    const PixelRect& rect) {
  const std::size_t reach = filter.reach();
  const auto w = static_cast<std::size_t>(film.width), h = static_cast<std::size_t>(film.height);
  const PixelRect around{rect.x0 - std::min(rect.x0, reach), rect.y0 - std::min(rect.y0, reach),
                         std::min(rect.x1 + reach, w), std::min(rect.y1 + reach, h)};
  const Quarters quarters(film, around);
  std::vector<PixelEstimate> pixels;
  pixels.reserve((rect.x1 - rect.x0) * (rect.y1 - rect.y0));
  std::vector<Means> columns(quarters.columns());
  for (std::size_t y = rect.y0; y < rect.y1; ++y) {
    std::fill(columns.begin(), columns.end(), Means{});
    visit_halves(filter, y, around.y0, around.y1, [&](double weight, std::size_t half) {
      const Means* row = quarters.row(half);
      for (std::size_t i = 0; i < columns.size(); ++i)
        add(columns[i], weight, row[i]);
    });
    for (std::size_t x = rect.x0; x < rect.x1; ++x) {
      Means sum{};
      visit_halves(filter, x, around.x0, around.x1, [&](double weight, std::size_t half) {
        add(sum, weight, columns[half - 2 * around.x0]);
      });
      pixels.push_back(estimate_of(sum));
    }
  }
  return pixels;
}

}  // namespace ds
