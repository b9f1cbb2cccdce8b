// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/degrees.h"

#include <cmath>

namespace ds {
namespace {

// Taylor series on [-45, 45] degrees; the first term left out is below 2^-60 there.
double sin_near_zero(double degrees) {
  const double x = degrees * (3.141592653589793238462643 / 180.0);
  const double x2 = x * x;
  double sum = 0;
  for (int k = 17; k >= 3; k -= 2)
    sum = (sum + 1.0) * (-x2 / static_cast<double>(k * (k - 1)));
  return x + x * sum;
}

double cos_near_zero(double degrees) {
  const double x = degrees * (3.141592653589793238462643 / 180.0);
  const double x2 = x * x;
  double sum = 0;
  for (int k = 18; k >= 2; k -= 2)
    sum = (sum + 1.0) * (-x2 / static_cast<double>(k * (k - 1)));
  return 1.0 + sum;
}

}  // namespace

double sin_deg(double degrees) {
  const double quarter = std::nearbyint(degrees / 90.0);
  const double rest =
      degrees - quarter * 90.0;  // exact: both are multiples of the angle's last bit
  switch (static_cast<long>(quarter) & 3) {
    case 0:
      return sin_near_zero(rest);
    case 1:
      return cos_near_zero(rest);
    case 2:
      return -sin_near_zero(rest);
    default:
      return -cos_near_zero(rest);
  }
}

double cos_deg(double degrees) {
  const double quarter = std::nearbyint(degrees / 90.0);
  const double rest = degrees - quarter * 90.0;
  switch (static_cast<long>(quarter) & 3) {
    case 0:
      return cos_near_zero(rest);
    case 1:
      return -sin_near_zero(rest);
    case 2:
      return -cos_near_zero(rest);
    default:
      return sin_near_zero(rest);
  }
}

}  // namespace ds
