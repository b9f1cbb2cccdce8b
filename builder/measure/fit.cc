// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/fit.h"

#include "tracer/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace ds {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

}  // namespace

double student_t95(int freedom) {
  DS_ASSERT(freedom >= 1);
  constexpr std::array table{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};
  if (freedom <= static_cast<int>(table.size()))
    return table[static_cast<std::size_t>(freedom - 1)];
  // Abramowitz and Stegun 26.7.5, first four terms.
  const double z = 1.959964;
  const double n = freedom;
  const double z3 = z * z * z;
  const double z5 = z3 * z * z;
  const double z7 = z5 * z * z;
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

double mean_of(std::span<const double> values) {
  DS_ASSERT(!values.empty());
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation_of(std::span<const double> values) {
  if (values.size() < 2) return 0;
  const double mean = mean_of(values);
  double sum = 0;
  for (const double value : values)
    sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double median_of(std::vector<double> values) {
  DS_ASSERT(!values.empty());
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

Interval mean_interval(std::span<const double> values) {
  const double mean = mean_of(values);
  if (values.size() < 2) return {mean, mean, mean};
  const double half = student_t95(static_cast<int>(values.size()) - 1) * deviation_of(values) /
                      std::sqrt(static_cast<double>(values.size()));
  return {mean, mean - half, mean + half};
}

std::optional<Interval> mapped_interval(std::span<const double> values,
                                        const std::function<double(double)>& f, double at_zero) {
  const Interval mean = mean_interval(values);
  if (!(mean.value > 0)) return std::nullopt;
  const double one = mean.low > 0 ? f(mean.low) : at_zero;
  const double other = f(mean.high);
  return Interval{f(mean.value), std::min(one, other), std::max(one, other)};
}

Interval Line::slope_interval() const {
  if (points < 3) return {slope, -k_infinity, k_infinity};
  const double half = student_t95(points - 2) * residual / std::sqrt(sum_xx);
  return {slope, slope - half, slope + half};
}

Interval Line::interval_at(double x) const {
  double half = k_infinity;
  if (points > 2)
    half = student_t95(points - 2) * residual *
           std::sqrt(1.0 / points + (x - mean_x) * (x - mean_x) / sum_xx);
  return {at(x), at(x) - half, at(x) + half};
}

Line fit_line(std::span<const double> x, std::span<const double> y) {
  DS_ASSERT(x.size() == y.size() && x.size() >= 2);
  Line line;
  line.points = static_cast<int>(x.size());
  line.mean_x = mean_of(x);
  const double mean_y = mean_of(y);
  double sum_xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    line.sum_xx += (x[i] - line.mean_x) * (x[i] - line.mean_x);
    sum_xy += (x[i] - line.mean_x) * (y[i] - mean_y);
  }
  DS_ASSERT(line.sum_xx > 0);
  line.slope = sum_xy / line.sum_xx;
  line.intercept = mean_y - line.slope * line.mean_x;
  double squares = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    squares += (y[i] - line.at(x[i])) * (y[i] - line.at(x[i]));
  if (line.points > 2) line.residual = std::sqrt(squares / (line.points - 2));
  return line;
}

double PowerLaw::error(double n) const {
  return std::exp(line.at(std::log(n)));
}

std::optional<Interval> PowerLaw::n_for(double target) const {
  DS_ASSERT(target > 0);
  if (line.slope >= 0) return std::nullopt;
  const double x = (std::log(target) - line.intercept) / line.slope;
  const Interval there = line.interval_at(x);
  const double half = (there.high - there.value) / -line.slope;
  return Interval{std::exp(x), std::exp(x - half), std::exp(x + half)};
}

std::optional<PowerLaw> fit_power_law(std::span<const double> n, std::span<const double> errors) {
  DS_ASSERT(n.size() == errors.size());
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t i = 0; i < n.size(); ++i) {
    if (errors[i] <= 0) continue;
    x.push_back(std::log(n[i]));
    y.push_back(std::log(errors[i]));
  }
  if (x.size() < 2) return std::nullopt;
  const auto [least, most] = std::minmax_element(x.begin(), x.end());
  if (*least == *most) return std::nullopt;
  PowerLaw law;
  law.least_n = std::exp(*least);
  law.most_n = std::exp(*most);
  law.line = fit_line(x, y);
  return law;
}

}  // namespace ds
