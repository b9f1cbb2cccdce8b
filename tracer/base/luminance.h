// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"

#include <array>

namespace ds {

/// Weights of linear Rec.709 red, green and blue as the kernels have them (kernels/vec.h): of
/// errors, of lights to be sampled, of photons.
inline constexpr std::array k_luminance_weights = {0.2126, 0.7152, 0.0722};
/// As LuxCore has them: of what its files and tone maps define by luminance.
inline constexpr std::array k_luxcore_weights = {0.212671, 0.715160, 0.072169};

/// Summed from left to right, in double.
constexpr double luminance(Vec3d c) {
  const auto& w = k_luminance_weights;
  return w[0] * c.x + w[1] * c.y + w[2] * c.z;
}
constexpr double luminance(Vec3 c) {
  return luminance(Vec3d{double{c.x}, double{c.y}, double{c.z}});
}
constexpr double luxcore_luminance(Vec3d c) {
  const auto& w = k_luxcore_weights;
  return w[0] * c.x + w[1] * c.y + w[2] * c.z;
}
constexpr double luxcore_luminance(Vec3 c) {
  return luxcore_luminance(Vec3d{double{c.x}, double{c.y}, double{c.z}});
}

}  // namespace ds
