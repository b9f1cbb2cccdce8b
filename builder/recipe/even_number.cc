// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/even_number.h"

#include "tracer/base/hash.h"

#include <fmt/format.h>

namespace ds {
namespace {

void add_word(std::string& text, std::string_view word) {
  (text += word) += '\0';
}
void add_word(std::string& text, std::uint64_t number) {
  const fmt::format_int digits(number);
  add_word(text, std::string_view(digits.data(), digits.size()));
}

}  // namespace

double even_number(std::uint64_t seed, std::string_view identity, std::string_view key, int i,
                   int attempt) {
  std::string text;
  text.reserve(identity.size() + key.size() + 64);
  add_word(text, "dsbuild draw 1");
  add_word(text, seed);
  add_word(text, identity);
  add_word(text, key);
  add_word(text, static_cast<std::uint64_t>(i));
  add_word(text, static_cast<std::uint64_t>(attempt));
  return static_cast<double>(hash_text(text).high >> 11U) * 0x1p-53;
}

}  // namespace ds
