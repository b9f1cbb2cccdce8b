// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace ds {

/// `text` without the byte order mark that some systems write before UTF-8.
inline std::string_view without_bom(std::string_view text) {
  constexpr std::string_view k_mark = "\xef\xbb\xbf";
  return text.starts_with(k_mark) ? text.substr(k_mark.size()) : text;
}

/// Whether a text begins with the byte order mark of UTF-16: no file of ours is written so.
inline bool is_utf16(std::string_view text) {
  return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
}
inline constexpr const char* k_utf16_message = "must be UTF-8, found UTF-16";

/// Takes the first line off `text`, which is not empty, and returns it without its end: "\n",
/// "\r\n" or "\r". The last line needs none.
inline std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find_first_of("\r\n");
  const std::string_view line = text.substr(0, end);
  if (end == text.npos)
    text = {};
  else
    text.remove_prefix(end + (text.substr(end).starts_with("\r\n") ? 2 : 1));
  return line;
}

}  // namespace ds
