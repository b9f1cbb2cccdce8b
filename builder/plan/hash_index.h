// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"
#include "tracer/base/hash.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace ds {

/// Where in a vector the row with a hash stands: one look instead of a search, for 8 bytes a row.
/// Open addressing with linear probing; the hash's own bits spread the rows.
class HashIndex {
 public:
  HashIndex() = default;
  /// `hash_of(i)` is row i's hash; of rows with one hash the first is found.
  template <typename HashOf>
  HashIndex(std::size_t count, const HashOf& hash_of)
      : slots_(std::bit_ceil(2 * std::max<std::size_t>(count, 1)), k_empty) {
    DS_ASSERT(count < k_empty);
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t& slot = slots_[slot_of(hash_of(i), hash_of)];
      if (slot == k_empty) slot = static_cast<std::uint32_t>(i);
    }
  }

  template <typename HashOf>
  std::optional<std::size_t> find(Hash128 hash, const HashOf& hash_of) const {
    if (slots_.empty()) return std::nullopt;
    const std::uint32_t row = slots_[slot_of(hash, hash_of)];
    if (row == k_empty) return std::nullopt;
    return row;
  }

 private:
  static constexpr std::uint32_t k_empty = std::numeric_limits<std::uint32_t>::max();

  /// The slot of the row with this hash, or the empty one where it would be.
  template <typename HashOf>
  std::size_t slot_of(Hash128 hash, const HashOf& hash_of) const {
    std::size_t slot = hash.low & (slots_.size() - 1);
    while (slots_[slot] != k_empty && hash_of(slots_[slot]) != hash)
      slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  std::vector<std::uint32_t> slots_;  ///< at most half full; rows or k_empty
};

}  // namespace ds
