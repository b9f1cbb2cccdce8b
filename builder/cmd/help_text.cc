// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/help_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace ds {

std::string wrap(std::string_view text, std::size_t indent, std::size_t column) {
  const std::string margin(indent, ' ');
  std::string wrapped;
  bool begun = column > indent;  // whether the line holds a word
  while (!text.empty()) {
    if (text.front() == '\n') {
      wrapped += '\n' + margin;
      column = indent;
      begun = false;
    }
    if (text.front() == '\n' || text.front() == ' ') {
      text.remove_prefix(1);
      continue;
    }
    const std::string_view word = text.substr(0, text.find_first_of(" \n"));
    text.remove_prefix(word.size());
    const bool first = wrapped.empty();
    if (begun && !first && column + 1 + word.size() > k_help_width) {
      wrapped += '\n' + margin;
      column = indent;
      begun = false;
    }
    if (begun && !first) {
      wrapped += ' ';
      ++column;
    }
    wrapped += word;
    column += word.size();
    begun = true;
  }
  return wrapped;
}

std::string help_rows(std::string_view title, const std::vector<HelpRow>& rows) {
  if (rows.empty()) return "";
  constexpr std::size_t k_widest = 24;
  std::size_t width = 0;
  for (const HelpRow& row : rows)
    if (row.name.size() <= k_widest) width = std::max(width, row.name.size());
  const std::size_t indent = 2 + width + 2;
  std::string text = fmt::format("{}:\n", title);
  for (const HelpRow& row : rows) {
    text += fmt::format("  {:<{}}", row.name, width);
    if (!row.help.empty()) {
      text += row.name.size() > width ? "\n" + std::string(indent, ' ') : "  ";
      text += wrap(row.help, indent, indent);
    }
    while (text.back() == ' ')
      text.pop_back();
    text += '\n';
  }
  return text;
}

}  // namespace ds
