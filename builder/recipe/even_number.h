// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ds {

/// An even number k * 2^-53 in [0, 1), number `i` of a key and identity:
///
///   (high 64 bits of XXH3-128(text) >> 11) * 2^-53
///   text = "dsbuild draw 1" NUL seed NUL identity NUL key NUL i NUL attempt NUL
///
/// with numbers in decimal digits. The 1 is the version of this rule.
double even_number(std::uint64_t seed, std::string_view identity, std::string_view key, int i,
                   int attempt);

using EvenNumberRule = decltype(&even_number);

/// What random numbers are drawn for. Part of every dataset made: a number is a pure function of
/// these words, whatever else a recipe holds and in whatever order it is asked.
struct DrawnFor {
  std::uint64_t seed = 0;               ///< dataset.seed
  std::string_view model, view;         ///< of the image
  std::uint64_t view_number = 0;        ///< as `view` says
  int attempt = 0;                      ///< how many draws of the image were rejected before
  EvenNumberRule number = even_number;  ///< another one in tests of a range's ends
};

}  // namespace ds
