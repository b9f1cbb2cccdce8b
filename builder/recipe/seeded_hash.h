// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace ds {

/// 64 bits that depend on the seed, the purpose and the words, each delimited so that ("ab", "c")
/// is not ("a", "bc"). The purpose is what the number is for, so that no two choices share one; its text is
/// part of every dataset made: never change one.
std::uint64_t seeded_hash(std::uint64_t seed, std::string_view purpose,
                          std::initializer_list<std::string_view> words);

/// The highest 53 bits: what a double, and so every JSON reader, holds exactly.
constexpr std::uint64_t top_53_bits(std::uint64_t hash) {
  return hash >> 11U;
}
/// In [0, 1).
constexpr double unit_interval(std::uint64_t hash) {
  return static_cast<double>(top_53_bits(hash)) * 0x1p-53;
}

}  // namespace ds
