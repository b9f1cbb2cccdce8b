// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace ds {

/// Chance of a chi-square value this great or greater (Wilson and Hilferty 1931; relative error
/// below a per cent for 10 and more degrees of freedom down to 1e-6).
inline double chi_square_chance(double value, double freedom) {
  const double spread = 2.0 / (9.0 * freedom);
  const double z = (std::cbrt(value / freedom) - (1.0 - spread)) / std::sqrt(spread);
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

/// Chance of counts this far from what is expected; cells that expect fewer than 5 are pooled.
inline double chance_of_counts(std::span<const double> counts, std::span<const double> expected) {
  double value = 0, freedom = 0, pooled_count = 0, pooled = 0;
  const auto add = [&](double count, double mean) {
    value += (count - mean) * (count - mean) / mean;
    freedom += 1;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] >= 5) {
      add(counts[i], expected[i]);
      continue;
    }
    pooled_count += counts[i];
    pooled += expected[i];
  }
  if (pooled >= 5) add(pooled_count, pooled);
  return chi_square_chance(value, freedom - 1);
}

/// Cells of equal solid angle: rows of equal height in z, each of equal azimuths.
struct SphereCells {
  int rows, columns;

  std::size_t count() const { return static_cast<std::size_t>(rows * columns); }
  /// The cell of a unit direction.
  std::size_t cell(double x, double y, double z) const {
    const double turn = std::atan2(y, x) / (2 * std::numbers::pi) + 0.5;
    const int row = std::min(static_cast<int>((z + 1) / 2 * rows), rows - 1);
    const int column = std::min(static_cast<int>(turn * columns), columns - 1);
    return static_cast<std::size_t>(row * columns + column);
  }
  /// Integral over each cell of `pdf`, a function of a unit direction's z and azimuth, by the
  /// middles of steps x steps parts.
  template <typename Pdf>
  std::vector<double> integrals(int steps, const Pdf& pdf) const {
    constexpr double pi = std::numbers::pi;
    std::vector<double> sums(count());
    for (int cell = 0; cell < rows * columns; ++cell)
      for (int i = 0; i < steps * steps; ++i) {
        const double z = -1 + 2 * (cell / columns + (i / steps + 0.5) / steps) / rows;
        const double azimuth =
            -pi + 2 * pi * (cell % columns + (i % steps + 0.5) / steps) / columns;
        sums[static_cast<std::size_t>(cell)] +=
            double{pdf(z, azimuth)} * 4 * pi / static_cast<double>(count()) / (steps * steps);
      }
    return sums;
  }
};

/// Chance that one of `tests` may show for all together to be at 0.01 (Sidak 1967).
inline double sidak(double tests) {
  return 1.0 - std::pow(1.0 - 0.01, 1.0 / tests);
}

}  // namespace ds
