// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

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

/// Chance that one of `tests` may show for all together to be at 0.01 (Sidak 1967).
inline double sidak(double tests) {
  return 1.0 - std::pow(1.0 - 0.01, 1.0 / tests);
}

}  // namespace ds
