// SPDX-License-Identifier: Apache-2.0
#include "manifests/export/run_lengths.h"

#include <algorithm>

namespace ds {

std::vector<std::uint32_t> run_lengths(const MaskPixels& mask) {
  std::vector<std::uint32_t> runs;
  bool set = false;
  std::uint32_t length = 0;
  for (int x = 0; x < mask.width; ++x)
    for (int y = 0; y < mask.height; ++y) {
      const bool here =
          mask.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width) +
                      static_cast<std::size_t>(x)] != 0;
      if (here != set) {
        runs.push_back(length);
        length = 0;
        set = here;
      }
      ++length;
    }
  runs.push_back(length);
  return runs;
}

std::string run_length_text(const std::vector<std::uint32_t>& runs) {
  std::string text;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::int64_t value = runs[i];
    if (i > 2) value -= runs[i - 2];
    for (bool more = true; more;) {
      std::int64_t digit = value & 31;
      value >>= 5;  // arithmetic: of a negative number -1 is left at the end
      more = (digit & 16) != 0 ? value != -1 : value != 0;
      if (more) digit |= 32;
      text.push_back(static_cast<char>(digit + 48));
    }
  }
  return text;
}

std::uint64_t area_of(const MaskPixels& mask) {
  return static_cast<std::uint64_t>(
      std::count_if(mask.values.begin(), mask.values.end(), [](std::uint8_t v) { return v != 0; }));
}

}  // namespace ds
