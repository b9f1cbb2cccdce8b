// SPDX-License-Identifier: Apache-2.0
// Transcendental functions from + - * / and fma alone: OpenCL's built-ins give other bits on other
// devices. Each states its domain and its greatest error, which tests/tracer/kernels/math_test.cc
// holds it to.
#pragma once

#include "tracer/kernels/vec.h"

#define DS_PI 3.14159265f
#define DS_INV_PI 0.318309886f
#define DS_INV_TWO_PI 0.159154943f

/// sqrt of what should be >= 0 but may have rounded below.
DS_FN real safe_sqrt(real x) {
  return sqrt(greater(x, (real)(0.0f)));
}

typedef struct {
  real sin, cos;
} SinCos;

/// sin and cos of 2 pi u. Domain |u| <= 2^20; absolute error below 2e-7 plus that of u. Quadrant by
/// rounding 4 u, then minimax polynomials on [-pi/4, pi/4] (coefficients of Moshier's sinf and
/// cosf, 1989).
DS_FN SinCos sin_cos_turns(real u) {
  const real quarter_turns = u * 4.0f;
  const real nearest = floor(quarter_turns + 0.5f);
  const integer quadrant = to_integer(nearest);
  const real r = (quarter_turns - nearest) * 1.57079632679f;
  const real r2 = r * r;
  const real s = r * fma(r2,
                         fma(r2, fma(r2, (real)(-1.9515295891e-4f), (real)(8.3321608736e-3f)),
                             (real)(-1.6666654611e-1f)),
                         (real)(1.0f));
  const real c =
      fma(r2,
          fma(r2,
              fma(r2, fma(r2, (real)(2.443315711809948e-5f), (real)(-1.388731625493765e-3f)),
                  (real)(4.166664568298827e-2f)),
              (real)(-0.5f)),
          (real)(1.0f));
  const mask swap = (quadrant & 1) != 0;
  const real sine = choose(swap, c, s);
  const real cosine = choose(swap, s, c);
  SinCos result;
  result.sin = choose((quadrant & 2) != 0, -sine, sine);
  result.cos = choose(((quadrant + 1) & 2) != 0, -cosine, cosine);
  return result;
}

/// sin x. Domain |x| <= 1e4; absolute error below 1e-6 (|x| + 1). Beyond 2^26 turns, where a
/// float's neighbour is 8 turns away, the same for all x.
DS_FN real sine(real x) {
  const real turns = x * DS_INV_TWO_PI;
  return sin_cos_turns(lesser(greater(turns, (real)(-67108864.0f)), (real)(67108864.0f))).sin;
}

/// e^x. Results are held in [2^-127, 2^127]; relative error below 3e-7 for |x| <= 80.
DS_FN real exponential(real x) {
  real y = x * 1.44269504f;
  y = greater(lesser(y, (real)(126.0f)), (real)(-126.0f));
  const real whole = floor(y + 0.5f);
  // The rest is taken from x itself: y has lost log2(y) bits.
  const real rest = fma(whole, (real)(-6.9314575195e-1f), x);
  const real f =
      lesser(greater(fma(whole, (real)(-1.4286067653e-6f), rest), (real)(-0.35f)), (real)(0.35f));
  real p = fma(f, (real)(1.9875691500e-4f), (real)(1.3981999507e-3f));
  p = fma(f, p, (real)(8.3334519073e-3f));
  p = fma(f, p, (real)(4.1665795894e-2f));
  p = fma(f, p, (real)(1.6666665459e-1f));
  p = fma(f, p, (real)(5.0000001201e-1f));
  p = fma(f * f, p, f) + 1.0f;
  return p * real_of(to_natural(whole + 127.0f) << 23);
}

/// ln x. Domain x in [2^-126, 3.4e38]; smaller x (0 and negatives too) counts as 2^-126. Absolute
/// error below 1e-7 (|ln x| + 1).
DS_FN real logarithm(real x) {
  const natural bits = bits_of(greater(x, (real)(1.17549435e-38f)));
  const real m = real_of((bits & 0x007fffffu) | 0x3f800000u);
  const mask upper = m > 1.41421356f;
  const real mantissa = choose(upper, m * 0.5f, m);
  const real exponent = to_real(bits >> 23) - choose(upper, (real)(126.0f), (real)(127.0f));
  const real s = (mantissa - 1.0f) / (mantissa + 1.0f);
  const real z = s * s;
  const real p =
      s * fma(z,
              fma(z, fma(z, fma(z, (real)(0.2222222222f), (real)(0.2857142857f)), (real)(0.4f)),
                  (real)(0.6666666667f)),
              (real)(2.0f));
  return fma(exponent, (real)(0.693147181f), p);
}

/// a^b for a >= 0; 0^b is 0 for b > 0.
DS_FN real power(real a, real b) {
  return choose(a > 0.0f, exponential(b * logarithm(a)),
                choose(b > 0.0f, (real)(0.0f), (real)(1.0f)));
}

/// Angle of (x, y) in turns, [-0.5, 0.5]; atan2(0, 0) is 0. Absolute error below 1e-7 turns.
DS_FN real arctangent_turns(real y, real x) {
  const real ax = absolute(x);
  const real ay = absolute(y);
  const mask steep = ay > ax;
  const real big = greater(choose(steep, ay, ax), (real)(1e-37f));
  const real t = choose(steep, ax, ay) / big;
  // Beyond tan(pi/8) the angle is pi/4 plus that of (t-1)/(t+1), so that the polynomial stays
  // short.
  const mask far = t > 0.414213562f;
  const real r = choose(far, (t - 1.0f) / (t + 1.0f), t);
  const real z = r * r;
  const real p = fma(z,
                     fma(z, fma(z, (real)(8.05374449538e-2f), (real)(-1.38776856032e-1f)),
                         (real)(1.99777106478e-1f)),
                     (real)(-3.33329491539e-1f));
  real angle = fma(p * z, r, r) + choose(far, (real)(0.785398163f), (real)(0.0f));
  angle = angle * DS_INV_TWO_PI;
  angle = choose(steep, 0.25f - angle, angle);
  angle = choose(x < 0.0f, 0.5f - angle, angle);
  return choose(y < 0.0f, -angle, angle);
}

/// arccos z in turns, [0, 0.5], for z in [-1, 1] (held there).
DS_FN real arccosine_turns(real z) {
  return arctangent_turns(safe_sqrt((1.0f - z) * (1.0f + z)), z);
}

/// Adds x to *sum + *rest, a sum of two floats that is never added up: *rest is below half an ulp
/// of *sum (Neumaier 1974, and Dekker's renormalisation 1971, without which the small parts that
/// rounding cuts off pile up in a float of their own and are cut off in turn: 6e-5 after a million
/// equal samples). Exact to 2^-46 for each addition.
DS_FN void add_compensated(real* sum, real* rest, real x) {
  const real total = *sum + x;
  const mask sum_is_greater = absolute(*sum) >= absolute(x);
  const real lost = choose(sum_is_greater, (*sum - total) + x, (x - total) + *sum);
  const real low = *rest + lost;
  *sum = total + low;
  *rest = low - (*sum - total);
}

DS_FN real power5(real x) {
  const real x2 = x * x;
  return x2 * x2 * x;
}
