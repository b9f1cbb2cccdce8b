// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace ds {

/// A value and the bounds it lies between with 95 % confidence: low <= value <= high. An infinite
/// bound is an open end: nothing is known on that side.
struct Interval {
  double value = 0, low = 0, high = 0;
};

/// Two-sided 95 % quantile of Student's t with `freedom` >= 1 degrees of freedom, to within 0.1 %.
double student_t95(int freedom);

double mean_of(std::span<const double> values);
/// Sample standard deviation; 0 for fewer than two values.
double deviation_of(std::span<const double> values);
double median_of(std::vector<double> values);
/// Mean of independent measurements and its interval; one value has no interval (low = high).
Interval mean_interval(std::span<const double> values);
/// The interval of f(mean) for a mean that cannot be below 0, though measurements of it can by
/// chance; `f` rises or falls throughout above 0 and is not asked elsewhere. Where the mean's lower
/// bound is not above 0, the end that it gives is `at_zero`, the limit of `f` there. Nothing where
/// the mean itself is not above 0.
std::optional<Interval> mapped_interval(std::span<const double> values,
                                        const std::function<double(double)>& f, double at_zero);

/// Least squares y = intercept + slope x.
struct Line {
  double intercept = 0, slope = 0;
  double residual = 0;            ///< standard deviation of the points about the line
  double mean_x = 0, sum_xx = 0;  ///< of the points; sum of squares about the mean
  int points = 0;

  double at(double x) const { return intercept + slope * x; }
  /// Of the line at `x`: what the scatter of the points leaves of the mean there; open on both
  /// sides for two points.
  Interval interval_at(double x) const;
  /// Of the slope; open on both sides for two points: a line goes through them whatever they are.
  Interval slope_interval() const;
};
/// At least two points of different x, all finite.
Line fit_line(std::span<const double> x, std::span<const double> y);

/// error = c n^slope, fitted as a line through the logarithms.
struct PowerLaw {
  Line line;
  double least_n = 0, most_n = 0;  ///< between which it was measured

  double error(double n) const;
  /// Where the error falls to `target`, with the interval that the scatter of the points leaves
  /// (inverse prediction of the mean); two points leave it open. Nothing where the error does not
  /// fall.
  std::optional<Interval> n_for(double target) const;
};
/// Points whose error is not above 0 (lost in the reference's noise) are left out. Nothing where
/// fewer than two are left.
std::optional<PowerLaw> fit_power_law(std::span<const double> n, std::span<const double> errors);

}  // namespace ds
