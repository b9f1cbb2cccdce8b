// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_math.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace ds::portable {
namespace {

constexpr double k_half_pi = 1.5707963267948966;
// ln 2 and pi/2 in two parts: the first has enough trailing zeros for an exact product with a small
// integer.
constexpr double k_ln2_high = 6.93147180369123816490e-01;
constexpr double k_ln2_low = 1.90821492927058770002e-10;
constexpr double k_half_pi_high = 1.57079632673412561417e+00;
constexpr double k_half_pi_low = 6.07710050650619224932e-11;

/// Taylor series of sine and cosine; |x| <= pi/4, so that x^18/18! is below 2e-18.
double sin_series(double x) {
  const double x2 = x * x;
  double term = x;
  double sum = x;
  for (int n = 3; n <= 19; n += 2) {
    term *= -x2 / (n * (n - 1));
    sum += term;
  }
  return sum;
}

double cos_series(double x) {
  const double x2 = x * x;
  double term = 1;
  double sum = 1;
  for (int n = 2; n <= 20; n += 2) {
    term *= -x2 / (n * (n - 1));
    sum += term;
  }
  return sum;
}

/// sin(x + quarter_turns * pi/2).
double sin_turned(double x, int quarter_turns) {
  const double turns = std::floor(x / k_half_pi + 0.5);
  const double rest = (x - turns * k_half_pi_high) - turns * k_half_pi_low;
  switch ((static_cast<int>(turns) + quarter_turns) & 3) {
    case 0:
      return sin_series(rest);
    case 1:
      return cos_series(rest);
    case 2:
      return -sin_series(rest);
    default:
      return -cos_series(rest);
  }
}

/// atan for 0 <= x <= 1: halved twice, then the series up to x^27 (|x| <= 0.2).
double atan_unit(double x) {
  x = x / (1 + std::sqrt(1 + x * x));
  x = x / (1 + std::sqrt(1 + x * x));
  const double x2 = x * x;
  double sum = 0;
  for (int n = 27; n >= 1; n -= 2)
    sum = 1.0 / n - x2 * sum;
  return 4 * x * sum;
}

}  // namespace

double exp(double x) {
  if (x > 710) return std::numeric_limits<double>::infinity();
  if (x < -745) return 0;
  const double k = std::floor(x / (k_ln2_high + k_ln2_low) + 0.5);
  const double r = (x - k * k_ln2_high) - k * k_ln2_low;
  double sum = 1;
  for (int n = 14; n >= 1; --n)
    sum = 1 + r * sum / n;
  return std::ldexp(sum, static_cast<int>(k));
}

double log(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < 0.7071067811865476) {
    m *= 2;
    --exponent;
  }
  const double s = (m - 1) / (m + 1);
  const double s2 = s * s;
  double sum = 0;
  for (int n = 25; n >= 1; n -= 2)
    sum = 1.0 / n + s2 * sum;
  return exponent * k_ln2_high + (exponent * k_ln2_low + 2 * s * sum);
}

double pow(double x, double y) {
  if (y == 0) return 1;
  if (x == 0) return 0;
  return x == 1 ? 1 : exp(y * log(x));
}

double sin(double x) {
  return sin_turned(x, 0);
}

double cos(double x) {
  return sin_turned(x, 1);
}

double atan2(double y, double x) {
  const double ax = x < 0 ? -x : x;
  const double ay = y < 0 ? -y : y;
  if (ax == 0 && ay == 0) return 0;
  double angle = ay <= ax ? atan_unit(ay / ax) : k_half_pi - atan_unit(ax / ay);
  if (x < 0) angle = k_pi - angle;
  return y < 0 ? -angle : angle;
}

double acos(double x) {
  return atan2(std::sqrt((1 - x) * (1 + x)), x);
}

double determinant(const Mat4& matrix) {
  const std::array<double, 16>& m = matrix.m;
  return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
         m[2] * (m[4] * m[9] - m[5] * m[8]);
}

Mat4 inverse(const Mat4& matrix) {
  const std::array<double, 16>& m = matrix.m;
  const double d = determinant(matrix);
  Mat4 r;
  r.m = {(m[5] * m[10] - m[6] * m[9]) / d,
         (m[2] * m[9] - m[1] * m[10]) / d,
         (m[1] * m[6] - m[2] * m[5]) / d,
         0,
         (m[6] * m[8] - m[4] * m[10]) / d,
         (m[0] * m[10] - m[2] * m[8]) / d,
         (m[2] * m[4] - m[0] * m[6]) / d,
         0,
         (m[4] * m[9] - m[5] * m[8]) / d,
         (m[1] * m[8] - m[0] * m[9]) / d,
         (m[0] * m[5] - m[1] * m[4]) / d,
         0,
         0,
         0,
         0,
         1};
  const Vec3d moved = r.direction({m[3], m[7], m[11]});
  r.m[3] = -moved.x;
  r.m[7] = -moved.y;
  r.m[11] = -moved.z;
  return r;
}

Vec3d transform_normal(const Mat4& inverse_of_m, Vec3d n) {
  const std::array<double, 16>& m = inverse_of_m.m;
  return normalized(Vec3d{m[0] * n.x + m[4] * n.y + m[8] * n.z,
                          m[1] * n.x + m[5] * n.y + m[9] * n.z,
                          m[2] * n.x + m[6] * n.y + m[10] * n.z});
}

}  // namespace ds::portable
