// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/canonical.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

template <typename T>
std::string hex_floats(std::span<const T> values) {
  std::string text;
  for (const T value : values) {
    if (!text.empty()) text += ' ';
    text += hex_float(value);
  }
  return text;
}

}  // namespace

std::string hex_float(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  return fmt::format("{:a}", value);
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
