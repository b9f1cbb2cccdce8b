// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_values.h"

#include "tracer/scene/sdl_math.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace ds {

std::optional<double> parse_sdl_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_float = std::fabs(value) <= double{std::numeric_limits<float>::max()};
  if (error != std::errc() || end != text.data() + text.size() || !is_float) return std::nullopt;
  return value;
}

std::vector<std::string> words_of(const Property& property) {
  std::vector<std::string> words;
  for (const std::string& value : property.values)
    for (std::size_t start = value.find_first_not_of(" \t"); start != std::string::npos;) {
      const std::size_t end = value.find_first_of(" \t", start);
      words.push_back(value.substr(start, end - start));
      start = end == std::string::npos ? end : value.find_first_not_of(" \t", end);
    }
  return words;
}

std::string joined(const Property& property) {
  return fmt::format("{}", fmt::join(property.values, " "));
}

std::optional<double> take_color_space(std::vector<std::string>& words) {
  if (words.empty()) return 1.0;
  if (words[0] == "nop") {
    words.erase(words.begin());
    return 1.0;
  }
  if (words[0] == "luxcore" && words.size() > 1) {
    const std::optional<double> gamma = parse_sdl_number(words[1]);
    words.erase(words.begin(), words.begin() + 2);
    if (gamma && *gamma > 0) return gamma;
    return std::nullopt;
  }
  return words[0] == "opencolorio" ? std::nullopt : std::optional(1.0);
}

double linear(double value, double gamma) {
  return gamma == 1 || value < 0 ? value : portable::pow(value, gamma);
}

}  // namespace ds
