// SPDX-License-Identifier: Apache-2.0
// The kernels' headers; in double, with the C library's functions in place of math.h's polynomials.
#pragma once

#include "tracer/kernels/layout.h"

#include <numbers>

// clang-format off
#ifdef DS_REAL_DOUBLE
namespace ds::DS_KERNELS {
// math.h under other names, then the exact ones under its own: everything behind it takes these.
#define sin_cos_turns polynomial_sin_cos_turns
#define sine polynomial_sine
#define exponential polynomial_exponential
#define logarithm polynomial_logarithm
#define power polynomial_power
#define arctangent_turns polynomial_arctangent_turns
#define arccosine_turns polynomial_arccosine_turns
#include "tracer/kernels/math.h"
#undef sin_cos_turns
#undef sine
#undef exponential
#undef logarithm
#undef power
#undef arctangent_turns
#undef arccosine_turns
inline SinCos sin_cos_turns(real u) {
  const double angle = 2 * std::numbers::pi * (u - std::floor(u));
  return {std::sin(angle), std::cos(angle)};
}
inline real sine(real x) { return std::sin(x); }
inline real exponential(real x) { return std::exp(x); }
inline real logarithm(real x) { return std::log(x); }
inline real power(real a, real b) { return std::pow(a, b); }
inline real arctangent_turns(real y, real x) { return std::atan2(y, x) / (2 * std::numbers::pi); }
inline real arccosine_turns(real z) {
  return std::acos(std::fmin(std::fmax(z, -1.0), 1.0)) / (2 * std::numbers::pi);
}
}  // namespace ds::DS_KERNELS
#endif
// clang-format on

#include "tracer/kernels/all_nodes.h"
