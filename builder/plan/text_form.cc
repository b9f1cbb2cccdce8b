// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/text_form.h"

#include "tracer/base/error.h"

#include <algorithm>

namespace ds {

TextForm::TextForm(std::string_view text, std::span<const char* const> names) {
  for (const char* name : names) {
    const std::string entry = fmt::format("{} = ", name);
    std::size_t start = 0;
    while (!text.substr(start).starts_with(entry)) {
      start = text.find('\n', start);
      DS_ASSERT(start != text.npos);  // else the text has no such entry
      ++start;
    }
    start += entry.size();
    pieces_.emplace_back(text.substr(0, start));
    text.remove_prefix(std::min(text.find('\n', start), text.size()));
  }
  pieces_.emplace_back(text);
}

std::string_view TextForm::fill(std::span<const std::string_view> values) {
  DS_ASSERT(values.size() + 1 == pieces_.size());
  filled_.clear();
  auto piece = pieces_.begin();
  for (const std::string_view value : values) {
    filled_ += *piece++;
    filled_ += value;
  }
  filled_ += *piece;
  return filled_;
}

}  // namespace ds
