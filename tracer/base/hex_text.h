// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/hash.h"

#include <array>
#include <string_view>

namespace ds {

/// What Hash128::hex gives, without an allocation: a plan of 25,000 images writes hundreds of
/// thousands of them.
class HexText {
 public:
  HexText() : HexText(Hash128{}) {}
  explicit HexText(Hash128 hash);
  std::string_view text() const { return {digits_.data(), digits_.size()}; }

 private:
  std::array<char, 32> digits_;
};

}  // namespace ds
