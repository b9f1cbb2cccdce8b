// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/number_range.h"

#include <fmt/format.h>

#include <cmath>

namespace ds {

bool NumberRange::contains(double value) const {
  if (!std::isfinite(value)) return false;
  return (open_least ? value > least : value >= least) &&
         (open_most ? value < most : value <= most);
}

std::string NumberRange::text() const {
  if (std::isinf(least) && std::isinf(most)) return "";
  if (std::isinf(most)) return fmt::format("{} {}", open_least ? ">" : ">=", least);
  if (std::isinf(least)) return fmt::format("{} {}", open_most ? "<" : "<=", most);
  return fmt::format("in {}{}, {}{}", open_least ? '(' : '[', least, most, open_most ? ')' : ']');
}

}  // namespace ds
