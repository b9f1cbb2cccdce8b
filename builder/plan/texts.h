// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/hash.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace ds {

/// Finds a text by its hash, in memory or in the database.
using TextLookup = std::function<std::optional<std::string>(Hash128)>;

/// Canonical texts by the hash of what is kept. A value longer than `k_longest_value` (the
/// program's text, which many images share) is kept as a text of its own and stands as "@" and its
/// hash.
class TextSet {
 public:
  static constexpr std::size_t k_longest_value = 200;
  static constexpr char k_reference = '@';

  /// Keeps the long values and gives the text that is left, its own hash not yet kept.
  std::string fold(std::string_view canonical);
  /// Keeps the folded text too. The hash is of it and depends on every byte of `canonical`.
  Hash128 add(std::string_view canonical);
  /// So many texts will be kept.
  void reserve(std::size_t count) { texts_.reserve(count); }
  /// Keeps a folded text whose hash is known.
  void put(Hash128 hash, std::string folded) { texts_.try_emplace(hash, std::move(folded)); }
  /// The folded text.
  const std::string* find(Hash128 hash) const;
  /// How many texts are kept, the long values among them.
  std::size_t size() const { return texts_.size(); }
  /// Calls `visit` for the text and for those it refers to.
  void visit(Hash128 hash, const std::function<void(Hash128, const std::string&)>& visit) const;

 private:
  struct HashOfHash {
    std::size_t operator()(Hash128 hash) const { return static_cast<std::size_t>(hash.low); }
  };
  std::unordered_map<Hash128, std::string, HashOfHash> texts_;
};

/// The whole text again. A text that cannot be found leaves its reference in place.
std::string unfold(std::string_view folded, const TextLookup& find);

/// One property that differs between two canonical texts.
struct PropertyChange {
  std::string name;
  std::optional<std::string> before, after;  ///< absent: the property was added or removed
};

/// In the order of `after`, then what only `before` has. Texts may be folded, both or none.
std::vector<PropertyChange> diff_texts(std::string_view before, std::string_view after);

/// "0x1p-1 0x1p-2" as "0.5 0.25"; anything else as it is.
std::string readable_value(std::string_view value);

/// "kd: 0.5 -> 0.25", "kd: added 0.5", "kd: removed (was 0.5)". A long value is only said to
/// differ.
std::string to_string(const PropertyChange& change);

/// The lines that differ between two long values (line breaks escaped as in a canonical text), "-
/// old" and "+ new", at most `most` of them.
std::vector<std::string> diff_lines(std::string_view before, std::string_view after,
                                    std::size_t most);

}  // namespace ds
