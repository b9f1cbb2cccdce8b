// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace ds::testing {

inline std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);)
    lines.push_back(line);
  return lines;
}

/// That a page, by its path from the root, holds the text between its comments "reference: begin" and
/// "reference: end", or up to its end. Under `ci/references --update`, which says so by
/// DS_UPDATE_REFERENCES, it is made to.
inline void expect_page_holds(std::string_view page, const std::string& wanted) {
  const std::filesystem::path path = std::filesystem::path(DS_SOURCE_DIR) / page;
  const std::string text = read_text_file(path);
  constexpr std::string_view k_begin = "<!-- reference: begin -->\n",
                             k_end = "<!-- reference: end -->";
  const std::size_t begin = text.find(k_begin);
  ASSERT_NE(begin, text.npos) << page;
  const std::size_t start = begin + k_begin.size(), end = std::min(text.find(k_end), text.size());
  const std::string held = text.substr(start, end - start);
  if (std::getenv("DS_UPDATE_REFERENCES") != nullptr) {
    if (held != wanted) write_file_atomic(path, text.substr(0, start) + wanted + text.substr(end));
    return;
  }
  const auto held_lines = lines_of(held), wanted_lines = lines_of(wanted);
  const auto [differs, other] =
      std::mismatch(held_lines.begin(), held_lines.end(), wanted_lines.begin(), wanted_lines.end());
  EXPECT_TRUE(differs == held_lines.end() && other == wanted_lines.end())
      << page
      << " is behind the tables: `ci/references --update` writes it anew. The first line that "
      << "differs\nholds  " << (differs == held_lines.end() ? "nothing" : *differs) << "\nwanted "
      << (other == wanted_lines.end() ? "nothing" : *other);
}

}  // namespace ds::testing
