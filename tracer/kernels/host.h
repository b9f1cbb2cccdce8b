// SPDX-License-Identifier: Apache-2.0
// The kernel headers as C++20, one lane wide: the same equations on the host, for tables, tests and
// precision audits. Compiled with contraction off and IEEE arithmetic, they give the device's bits.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace ds::kernels {

using uint = std::uint32_t;
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

}  // namespace ds::kernels
