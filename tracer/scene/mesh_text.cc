// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_text.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace ds {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Whether a decimal number that no double can hold is too large rather than too small: the sign of
/// the decimal exponent of its first digit that is not 0.
bool is_huge(std::string_view digits) {
  std::int64_t exponent = 0;
  bool found = false, after_point = false;
  std::size_t i = 0;
  for (; i < digits.size() && (is_digit(digits[i]) || digits[i] == '.'); ++i) {
    if (digits[i] == '.') {
      after_point = true;
    } else {
      found = found || digits[i] != '0';
      // Up to the first such digit each place behind the point takes one off; before it adds one.
      if (after_point && !found) --exponent;
      if (!after_point && found) ++exponent;
    }
  }
  if (i < digits.size()) ++i;  // the 'e'
  const bool minus = i < digits.size() && digits[i] == '-';
  if (i < digits.size() && (digits[i] == '-' || digits[i] == '+')) ++i;
  std::int64_t written = 0;
  const auto result = std::from_chars(digits.data() + i, digits.data() + digits.size(), written);
  if (result.ec == std::errc::result_out_of_range) return !minus;
  return exponent + (minus ? -written : written) > 0;
}

}  // namespace

ParsedNumber parse_number(std::string_view text) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  const bool plus = begin != end && *begin == '+';
  const char* digits = begin + (plus ? 1 : 0);
  if (plus && digits != end && *digits == '-') return {};
  double value = 0;
  const auto [stop, code] = std::from_chars(digits, end, value);
  if (code == std::errc::invalid_argument) return {};
  if (code == std::errc::result_out_of_range) {
    const bool minus = *digits == '-';
    const char* unsigned_digits = digits + (minus ? 1 : 0);
    const bool huge = is_huge({unsigned_digits, static_cast<std::size_t>(stop - unsigned_digits)});
    value = std::copysign(huge ? std::numeric_limits<double>::infinity() : 0.0, minus ? -1.0 : 1.0);
  }
  return {value, static_cast<std::size_t>(stop - begin)};
}

std::string printable(std::string_view text) {
  constexpr std::size_t k_shown = 40;  // a damaged file may hold one endless word
  std::string shown(text.substr(0, k_shown));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  return shown;
}

double LineCursor::number() {
  const ParsedNumber parsed = parse_number({at_, bytes_left()});
  const char* stop = at_ + parsed.size;
  if (parsed.size == 0 || !is_break(stop)) not_a("a number");
  at_ = stop;
  return parsed.value;
}

std::int64_t LineCursor::integer() {
  std::int64_t value = 0;
  const auto [stop, code] = std::from_chars(at_, end_, value);
  if (code != std::errc() || !is_break(stop)) not_a("an integer");
  at_ = stop;
  return value;
}

std::uint32_t LineCursor::index() {
  std::uint32_t value = 0;
  const auto [stop, code] = std::from_chars(at_, end_, value);
  if (code == std::errc() && is_break(stop)) {
    at_ = stop;
    return value;
  }
  return to_index(number());
}

std::string_view LineCursor::word() {
  if (line_done()) return {};
  const char* begin = at_;
  while (!is_break(at_))
    ++at_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

std::string_view LineCursor::rest_of_line() {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  while (at_ != end_ && is_blank(*at_))
    ++at_;
  const char* const begin = at_;
  while (at_ != end_ && *at_ != '\n' && *at_ != '\r')
    ++at_;
  const char* last = at_;
  while (last != begin && is_blank(last[-1]))
    --last;
  return {begin, static_cast<std::size_t>(last - begin)};
}

void LineCursor::skip_line() {
  while (at_ != end_ && *at_ != '\n' && *at_ != '\r')
    ++at_;
  if (at_ == end_) return;
  if (*at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n') ++at_;
  ++at_;
  ++line_;
}

void LineCursor::not_a(const char* wanted) {
  fail_here("wanted {}, found \"{}\"", wanted, printable(word()));
}

}  // namespace ds
