// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace ds {

/// Point `i` of a Kronecker sequence: the fraction of i times an irrational `step`. Points of d
/// dimensions cover [0, 1)^d evenly with the steps g^-1 ... g^-d, g^(d + 1) = g + 1 (Roberts 2018,
/// "The Unreasonable Effectiveness of Quasirandom Sequences").
inline double spread(int i, double step) {
  const double x = i * step;
  return x - std::floor(x);
}

}  // namespace ds
