// SPDX-License-Identifier: Apache-2.0
#include "builder/page/axis.h"

#include "tracer/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ds {
namespace {

double logarithm(double value, Scale scale) {
  return scale == Scale::log2 ? std::log2(value) : std::log10(value);
}

void widen_log(Axis& axis) {
  const double base = axis.scale == Scale::log2 ? 2 : 10;
  // A tenth of a decade on both sides keeps markers off the frame.
  const double room = std::pow(10, 0.1);
  axis.low /= room;
  axis.high *= room;
  if (axis.high / axis.low >= base) return;
  const double middle = std::sqrt(axis.low * axis.high);
  axis.low = middle / std::sqrt(base);
  axis.high = middle * std::sqrt(base);
}

std::vector<Tick> powers_of_two(double low, double high, int most_labels) {
  std::vector<Tick> ticks;
  const int first = static_cast<int>(std::ceil(std::log2(low) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log2(high) + 1e-9));
  const int step = (last - first) / most_labels + 1;
  for (int e = first; e <= last; ++e)
    ticks.push_back(
        {std::ldexp(1, e), (e - first) % step == 0 ? short_number(std::ldexp(1, e)) : ""});
  return ticks;
}

std::vector<Tick> decades(double low, double high, int most_labels) {
  std::vector<Tick> ticks;
  const double span = std::log10(high / low);
  const int step = static_cast<int>(span) / most_labels + 1;
  int exponent = static_cast<int>(std::floor(std::log10(low)));
  for (; std::pow(10, exponent) <= high * 1.000001; ++exponent)
    for (const int factor : {1, 2, 5}) {
      const double value = factor * std::pow(10.0, exponent);
      if (value < low * 0.999999 || value > high * 1.000001) continue;
      const bool labelled = factor == 1 ? exponent % step == 0 : span < 2.2;
      ticks.push_back({value, labelled ? short_number(value) : ""});
    }
  return ticks;
}

/// 1, 2 or 5 times a power of ten, so that about five steps span the range.
double nice_step(double range) {
  const double rough = range / 5;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (rough <= factor * power * 1.000001) return factor * power;
  return 10 * power;
}

void fit_linear(Axis& axis) {
  if (axis.low == 0 && axis.high == 0) axis.high = 1;
  if (axis.high - axis.low <= 1e-12 * std::max(std::abs(axis.low), std::abs(axis.high))) {
    const double room = std::abs(axis.low) * 0.5;
    axis.low -= room;
    axis.high += room;
  }
  const double step = nice_step(axis.high - axis.low);
  const double first = std::floor(axis.low / step + 1e-9);
  const double last = std::ceil(axis.high / step - 1e-9);
  axis.low = first * step;
  axis.high = last * step;
  for (int i = 0; first + i <= last; ++i)
    axis.ticks.push_back({(first + i) * step, short_number((first + i) * step)});
}

}  // namespace

double Axis::place(double value) const {
  if (scale == Scale::linear) return (value - low) / (high - low);
  return (logarithm(value, scale) - logarithm(low, scale)) /
         (logarithm(high, scale) - logarithm(low, scale));
}

Axis axis_for(const std::string& label, Scale scale, const std::vector<double>& values,
              int most_labels) {
  Axis axis{label, scale, 0, 1, {}};
  if (scale != Scale::linear) {
    axis.low = 1;
    axis.high = 10;
  }
  if (!values.empty()) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    axis.low = *least;
    axis.high = *most;
  }
  if (scale == Scale::linear) {
    fit_linear(axis);
    return axis;
  }
  DS_ASSERT(axis.low > 0);
  widen_log(axis);
  axis.ticks = scale == Scale::log2 ? powers_of_two(axis.low, axis.high, most_labels)
                                    : decades(axis.low, axis.high, most_labels);
  return axis;
}

std::string short_number(double value) {
  if (value == 0) return "0";
  const double size = std::abs(value);
  if (size >= 1000 && size < 1e6) return fmt::format("{:.0f}", value);
  return fmt::format("{:.3g}", value);
}

}  // namespace ds
