// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/make/made_journal.h"

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
  std::uint64_t to_make = 0;           ///< images, when the first began
  std::uint64_t samples_to_trace = 0;  ///< likewise
  MadeImages made;
  std::string device;  ///< that they traced on
  /// Where this one tells what it makes; null: nobody asks.
  MadeJournal* journal = nullptr;
  /// When the first one began; else this one.
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();

  /// Nothing where none died at the image.
  const CrashedImage* crash_of(std::string_view id) const;
  /// Nothing where none made any of the image.
  const MadeImage* made_of(std::string_view id) const;
};
/// "the process that made it died of signal 11 (Segmentation fault), 2 times".
std::string to_text(const CrashedImage& image);

}  // namespace ds
