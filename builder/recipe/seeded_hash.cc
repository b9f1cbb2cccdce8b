// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/seeded_hash.h"

#include "tracer/base/hash.h"

#include <fmt/format.h>

#include <string>

namespace ds {

std::uint64_t seeded_hash(std::uint64_t seed, std::string_view purpose,
                          std::initializer_list<std::string_view> words) {
  std::string text = fmt::format_int(seed).str();
  (text += '\n') += purpose;
  for (const std::string_view word : words) {
    const fmt::format_int size(word.size());
    (text += '\n').append(size.data(), size.size());
    (text += ' ') += word;
  }
  return hash64_text(text);
}

}  // namespace ds
