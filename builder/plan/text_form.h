// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/hash.h"

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// A canonical text that thousands of images have in common but for the values of some entries:
/// written once, filled in for each.
class TextForm {
 public:
  TextForm() = default;
  /// `names` are the entries to fill, in the order in which they stand in the text; their values
  /// there are dropped.
  TextForm(std::string_view text, std::span<const char* const> names);
  TextForm(std::string_view text, std::initializer_list<const char*> names)
      : TextForm(text, std::span(names.begin(), names.size())) {}

  /// The text with these values, one for each name. Valid until the next call; values must be as
  /// CanonicalText writes them.
  std::string_view fill(std::span<const std::string_view> values);
  std::string_view fill(std::initializer_list<std::string_view> values) {
    return fill(std::span(values.begin(), values.size()));
  }
  Hash128 hash(std::span<const std::string_view> values) { return hash_text(fill(values)); }
  Hash128 hash(std::initializer_list<std::string_view> values) { return hash_text(fill(values)); }

 private:
  std::vector<std::string> pieces_;  ///< what stands before, between and behind the values
  std::string filled_;
};

}  // namespace ds
