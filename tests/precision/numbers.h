// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/precision/questions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

/// Numbers that questions are made of, and how far one answer is from another.
namespace ds::audit {

/// Numbers in [0, 1), and the ends of that.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : random_(seed) {}
  float next() {
    const auto bits = static_cast<std::uint32_t>(random_());
    if (bits % 32 == 0) return 0;
    if (bits % 32 == 1) return 0.99999994f;
    return static_cast<float>(bits >> 8) * 0x1p-24f;
  }
  double between(double low, double high) { return low + (high - low) * double{next()}; }
  std::array<float, 3> direction() {
    const double z = between(-1, 1), turn = between(-M_PI, M_PI);
    const double s = std::sqrt(std::max(0.0, 1 - z * z));
    return {static_cast<float>(s * std::cos(turn)), static_cast<float>(s * std::sin(turn)),
            static_cast<float>(z)};
  }
  std::uint32_t bits() { return static_cast<std::uint32_t>(random_()); }

 private:
  std::mt19937 random_;
};

inline double distance(const Three& a, const Three& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
inline double greatest(const Three& a) {
  return std::max({std::fabs(a[0]), std::fabs(a[1]), std::fabs(a[2])});
}
/// Largest difference of a component over the largest component of `b`.
inline double relative(const Three& a, const Three& b) {
  const double scale = greatest(b);
  return scale == 0 ? greatest(a) : greatest({a[0] - b[0], a[1] - b[1], a[2] - b[2]}) / scale;
}
inline double relative(double a, double b) {
  return b == 0 ? std::fabs(a) : std::fabs(a - b) / std::fabs(b);
}

}  // namespace ds::audit
