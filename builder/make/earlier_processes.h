// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// An image during which processes died that made it, and how the last one did: "died of signal 11
/// (Segmentation fault)".
struct CrashedImage {
  std::string id, how;
  int times = 1;
};

/// Processes that die with an image before it counts as failed.
inline constexpr int k_most_crashes = 2;

/// What processes before this one made of the same build.
struct EarlierProcesses {
  std::vector<CrashedImage> crashed;
  std::uint64_t deaths = 0;
  std::uint64_t to_make = 0;  ///< images, when the first began
  /// Of what they made, as far as they came to tell.
  std::uint64_t traced = 0, developed = 0, samples = 0;
  /// When the first one began; else this one.
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();

  /// Nothing where none died at the image.
  const CrashedImage* crash_of(std::string_view id) const;
  /// Images that they made, of which `now` are still to make.
  std::uint64_t made(std::uint64_t now) const { return to_make - std::min(to_make, now); }
};
/// "the process that made it died of signal 11 (Segmentation fault), 2 times".
std::string to_text(const CrashedImage& image);

}  // namespace ds
