// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

namespace ds {

/// Chance that numbers of this distribution function lie at least so far from it as these do:
/// Kolmogorov and Smirnov's, with Stephens's correction for their count.
template <typename Share>
double ks_p(std::vector<double> numbers, const Share& share_below) {
  std::sort(numbers.begin(), numbers.end());
  const double count = static_cast<double>(numbers.size());
  double most = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double share = share_below(numbers[i]), at = static_cast<double>(i);
    most = std::max({most, share - at / count, (at + 1) / count - share});
  }
  const double root = std::sqrt(count), x = (root + 0.12 + 0.11 / root) * most;
  double p = 0;
  for (int k = 1; k <= 100; ++k)
    p += (k % 2 == 1 ? 2 : -2) * std::exp(-2 * k * k * x * x);
  return std::clamp(p, 0.0, 1.0);
}

/// Chance of counts at least so far from these shares as theirs are; 0 where a value was counted that has
/// no share. Wilson and Hilferty's approximation.
inline double chi_square_p(const std::map<double, double>& counts,
                           const std::map<double, double>& shares) {
  double of = 0, all = 0, sum = 0;
  for (const auto& [value, count] : counts) {
    if (!shares.contains(value)) return 0;
    of += count;
  }
  for (const auto& [value, share] : shares)
    all += share;
  for (const auto& [value, share] : shares) {
    const double wanted = of * share / all;
    const double found = counts.contains(value) ? counts.at(value) : 0;
    sum += (found - wanted) * (found - wanted) / wanted;
  }
  const double freedom = static_cast<double>(shares.size()) - 1, part = 2 / (9 * freedom);
  const double z = (std::cbrt(sum / freedom) - (1 - part)) / std::sqrt(part);
  return std::erfc(z / std::sqrt(2.0)) / 2;
}

}  // namespace ds
