// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/canonical.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace ds {
namespace {

void append_escaped(std::string& text, std::string_view value) {
  const auto is_special = [](char c) { return c == '\n' || c == '\r' || c == '\\'; };
  for (;;) {
    const auto special = std::find_if(value.begin(), value.end(), is_special);
    text.append(value.begin(), special);
    if (special == value.end()) return;
    text += *special == '\n' ? "\\n" : *special == '\r' ? "\\r" : "\\\\";
    value = {special + 1, value.end()};
  }
}

constexpr std::size_t k_most_hex = 32;  // "-0x1.fffffffffffffp-1022" and more

/// How many characters hex_float's text has. By hand: a plan writes dozens for each of thousands of images, and printf
/// takes five times as long.
std::size_t write_hex(double value, char* text) {
  const auto write = [&](std::string_view word) {
    return static_cast<std::size_t>(std::copy(word.begin(), word.end(), text) - text);
  };
  if (std::isnan(value)) return write("nan");
  if (std::isinf(value)) return write(value < 0 ? "-inf" : "inf");
  constexpr int k_least_exponent = -1022;  // of IEEE 754 doubles
  const auto bits = std::bit_cast<std::uint64_t>(value);
  std::uint64_t fraction = bits & ((std::uint64_t{1} << 52U) - 1);
  int exponent = static_cast<int>((bits >> 52U) & 0x7ffU) - 1023;
  const bool is_normal = exponent >= k_least_exponent;
  if (!is_normal) exponent = fraction == 0 ? 0 : k_least_exponent;
  std::size_t at = write(std::signbit(value) ? "-0x" : "0x");
  text[at++] = is_normal ? '1' : '0';
  if (fraction != 0) text[at++] = '.';
  for (; fraction != 0; fraction = (fraction << 4U) & ((std::uint64_t{1} << 52U) - 1))
    text[at++] = "0123456789abcdef"[fraction >> 48U];
  text[at++] = 'p';
  text[at++] = exponent < 0 ? '-' : '+';
  const fmt::format_int power(std::abs(exponent));
  std::copy_n(power.data(), power.size(), text + at);
  return at + power.size();
}

template <typename T>
std::string hex_floats(std::span<const T> values) {
  std::string text;
  text.reserve(values.size() * k_most_hex);
  for (const T value : values) {
    char digits[k_most_hex];
    if (!text.empty()) text += ' ';
    text.append(digits, write_hex(static_cast<double>(value), digits));
  }
  return text;
}

}  // namespace

std::string hex_float(double value) {
  char digits[k_most_hex];
  return {digits, write_hex(value, digits)};
}

std::string hex_float(float value) {
  return hex_float(static_cast<double>(value));
}

void CanonicalText::add(std::string_view name, std::string_view value) {
  text_ += name;
  text_ += " = ";
  append_escaped(text_, value);
  text_ += '\n';
}

void CanonicalText::add(std::string_view name, std::int64_t value) {
  add(name, fmt::format("{}", value));
}
void CanonicalText::add(std::string_view name, std::uint64_t value) {
  add(name, fmt::format("{}", value));
}
void CanonicalText::add(std::string_view name, std::span<const float> values) {
  add(name, hex_floats(values));
}
void CanonicalText::add(std::string_view name, std::span<const double> values) {
  add(name, hex_floats(values));
}

std::vector<std::pair<std::string, std::string>> parse_canonical(std::string_view text) {
  std::vector<std::pair<std::string, std::string>> entries;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    const std::size_t equals = line.find(" = ");
    if (equals == line.npos) continue;
    entries.emplace_back(line.substr(0, equals), line.substr(equals + 3));
  }
  return entries;
}

}  // namespace ds
