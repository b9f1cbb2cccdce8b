// SPDX-License-Identifier: Apache-2.0
// The kernel headers as C++20, one lane wide: the same equations on the host, for tables, tests and
// precision audits. Compiled with contraction off and IEEE arithmetic, they give the device's bits.
// With DS_REAL_DOUBLE defined, `real` is a double and the namespace ds::kernels_double:
// tests/precision compares the two.
#pragma once

#include "tracer/base/number_range.h"
#include "tracer/base/tan_half.h"
#include "tracer/base/vec.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>

/// What of a kernel file stands behind #ifdef DS_HOOK_HOST is the host's: no program asks for that hook
/// (device/program_text.cc), so nothing is stale when it changes.
#define DS_HOOK_HOST

#ifdef DS_REAL_DOUBLE
#  define DS_KERNELS kernels_double
#else
#  define DS_KERNELS kernels
#endif

namespace ds::DS_KERNELS {

using uint = std::uint32_t;
using std::copysign;
using std::fabs;
using std::floor;
using std::fma;
using std::sqrt;

inline uint leading_zeros(uint x) {
  return static_cast<uint>(std::countl_zero(x));
}
inline float as_float(uint bits) {
  return std::bit_cast<float>(bits);
}
inline uint as_uint(float value) {
  return std::bit_cast<uint>(value);
}

}  // namespace ds::DS_KERNELS
