// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace ds {

/// "pictures is clipped" behind "1 of 37": the text's first verb in the singular where `count` is 1, else as
/// it is.
inline std::string agreeing(std::uint64_t count, std::string text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 7> k_verbs{
      {{" are ", " is "},
       {" have ", " has "},
       {" show ", " shows "},
       {" cut ", " cuts "},
       {" stand ", " stands "},
       {" mean ", " means "},
       {" allow ", " allows "}}};
  std::size_t first = text.npos;
  std::pair<std::string_view, std::string_view> verb;
  for (const auto& one : k_verbs)
    if (const std::size_t at = text.find(one.first); at < first) {
      first = at;
      verb = one;
    }
  if (count == 1 && first != text.npos) text.replace(first, verb.first.size(), verb.second);
  return text;
}

}  // namespace ds
