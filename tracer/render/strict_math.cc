// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/strict_math.h"

#include "tracer/base/error.h"

#include <cmath>

namespace ds {
namespace {

constexpr double k_sqrt_half = 0.70710678118654752440;
// ln 2 in two parts: the first has 33 significant bits, so that a product with an exponent is
// exact.
constexpr double k_ln2_high = 0x1.62e42fefp-1;
constexpr double k_ln2_low = 0x1.473de6af278edp-34;
constexpr double k_log2_e = 1.44269504088896340736;

}  // namespace

double strict_log(double x) {
  DS_ASSERT(x > 0 && std::isfinite(x));
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // exact, as ldexp below
  if (m < k_sqrt_half) {
    m *= 2;
    --exponent;
  }
  // log m = 2 artanh(s) = 2 (s + s^3 / 3 + s^5 / 5 + ...), |s| <= 0.1716: the term in s^25 is below
  // 1e-20.
  const double s = (m - 1) / (m + 1);
  const double s2 = s * s;
  double series = 0;
  for (int k = 23; k >= 3; k -= 2)
    series = s2 * (1.0 / k + series);
  const double e = exponent;
  return e * k_ln2_high + (2 * s + (2 * s * series + e * k_ln2_low));
}

double strict_exp(double x) {
  if (x < -745.2) return 0;
  if (x > 709.8) return HUGE_VAL;
  const double n = std::floor(x * k_log2_e + 0.5);
  const double r = (x - n * k_ln2_high) - n * k_ln2_low;  // |r| <= 0.3466
  // e^r = 1 + r + r^2 / 2! + ...: the term in r^15 is below 2e-19.
  double series = 1;
  for (int k = 14; k >= 1; --k)
    series = 1 + series * r / k;
  return std::ldexp(series, static_cast<int>(n));
}

double strict_pow(double x, double y) {
  DS_ASSERT(x >= 0 && std::isfinite(x) && std::isfinite(y));
  DS_ASSERT(x > 0 || y > 0);
  if (x == 0) return 0;
  if (y == 1) return x;  // keeps gamma 1 exact
  return strict_exp(y * strict_log(x));
}

}  // namespace ds
