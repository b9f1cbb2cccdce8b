// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/error_text.h"

#include <charconv>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>

namespace ds {
namespace {

const char* name_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
      return "usage";
    case ErrorKind::recipe:
      return "recipe";
    case ErrorKind::asset:
      return "asset";
    case ErrorKind::io:
      return "io";
    case ErrorKind::device:
      return "device";
    case ErrorKind::cancelled:
      return "cancelled";
  }
  return "internal";
}

/// Takes ":NUMBER" off the end.
std::optional<int> take_number(std::string_view& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == 0 || colon == text.npos || colon + 1 == text.size()) return std::nullopt;
  const std::string_view digits = text.substr(colon + 1);
  int number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size() || number <= 0)
    return std::nullopt;
  text = text.substr(0, colon);
  return number;
}

nlohmann::json number_or_null(int number) {
  return number > 0 ? nlohmann::json(number) : nlohmann::json();
}

}  // namespace

PlacedMessage placed_message(const std::string& line) {
  const std::string_view all = line;
  // A file's name may hold ": " too: the first of them that makes sense.
  for (std::size_t end = all.find(": "); end != all.npos; end = all.find(": ", end + 2)) {
    std::string_view file = all.substr(0, end);
    const std::optional<int> last = take_number(file);
    const std::optional<int> before = last ? take_number(file) : std::nullopt;
    std::error_code error;
    if (!last && !std::filesystem::is_regular_file(std::filesystem::path(file), error)) continue;
    return {{std::string(file), before.value_or(last.value_or(0)), before ? *last : 0},
            std::string(all.substr(end + 2))};
  }
  return {{}, line};
}

nlohmann::json error_json(const std::exception& error) {
  const auto* known = dynamic_cast<const Error*>(&error);
  nlohmann::json failures = nlohmann::json::array();
  std::istringstream lines(error.what());
  for (std::string line; std::getline(lines, line);) {
    const auto [place, message] = placed_message(line);
    failures.push_back(
        {{"what", place.file.empty() ? "dsbuild" : to_string(place)},
         {"why", message},
         {"file", place.file.empty() ? nlohmann::json() : nlohmann::json(place.file)},
         {"line", number_or_null(place.line)},
         {"column", number_or_null(place.column)}});
  }
  return {{"error", error.what()},
          {"kind", known != nullptr ? name_of(known->kind()) : "internal"},
          {"exit_code", known != nullptr ? exit_code(known->kind()) : 1},
          {"failures", failures}};
}

}  // namespace ds
