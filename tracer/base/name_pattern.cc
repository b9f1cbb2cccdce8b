// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/name_pattern.h"

#include <cstddef>

namespace ds {

bool fits_pattern(std::string_view name, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  if (star == pattern.npos) return name == pattern;
  if (!name.starts_with(pattern.substr(0, star))) return false;
  for (std::size_t from = star; from <= name.size(); ++from)
    if (fits_pattern(name.substr(from), pattern.substr(star + 1))) return true;
  return false;
}

}  // namespace ds
