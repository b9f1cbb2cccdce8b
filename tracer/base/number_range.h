// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

namespace ds {

/// The numbers that a setting may have.
struct NumberRange {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool open_least = false, open_most = false;  ///< the bound itself is outside

  bool contains(double value) const;  ///< false for NaN and infinities
  std::string text() const;  ///< "in (0, 180)", ">= 0", "" where everything finite is inside
};

}  // namespace ds
