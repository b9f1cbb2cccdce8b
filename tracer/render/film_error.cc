// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/film_error.h"

#include "tracer/base/error.h"
#include "tracer/base/luminance.h"
#include "tracer/render/strict_math.h"

#include <algorithm>
#include <cmath>

namespace ds {
namespace {

double luminance_at(const float* rgb) {
  return luminance(Vec3{rgb[0], rgb[1], rgb[2]});
}

}  // namespace

ErrorEstimate ErrorSum::estimate(double scale, double count, double correlation) const {
  if (!(sum_ > 0) || !(scale > 0)) return {};
  const double n = std::max(1.0, 2 * sum_ * sum_ / sum_of_squares_ / correlation);
  // Student's 97.5 % quantile to first order in 1 / n, which keeps to F(n, n) from n = 5 on within
  // 5 % and is wider below.
  const double quantile = 1.96 + 2.37 / n;
  const double factor = strict_exp(quantile / std::sqrt(n));
  const double value = std::sqrt(sum_ / count) / scale;
  return {value, value / factor, value * factor};
}

std::optional<ErrorEstimate> luminance_error(const Film& film, const PixelFilter& filter) {
  if (film.halves.empty()) return std::nullopt;
  DS_ASSERT(film.halves.size() == film.rgb.size());
  const std::size_t pixels = film.rgb.size() / 3;
  ErrorSum sum;
  double mean = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const double d = luminance_at(film.halves.data() + 3 * i);
    mean += luminance_at(film.rgb.data() + 3 * i);
    sum.add(d * d);
  }
  const auto count = static_cast<double>(pixels);
  return sum.estimate(mean / count, count, filter.correlation());
}

}  // namespace ds
