// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace ds {

/// A decimal number at the start of `text` as a double, and how many characters it takes; 0 where
/// there is none. Locale-free and correctly rounded. One leading '+', "inf" and "nan" are read;
/// what is too large for a double is infinite, what is too small is 0.
struct ParsedNumber {
  double value = 0;
  std::size_t size = 0;
};
ParsedNumber parse_number(std::string_view text);

/// The beginning of a word from a file, fit for a message: at most 40 characters, and '?' for what
/// is not printable ASCII.
std::string printable(std::string_view text);

/// Walks a text line by line and number by number, skipping blank lines. Lines end with "\n",
/// "\r\n" or "\r". Cheap enough for millions of numbers.
class LineCursor {
 public:
  /// Starts before the first line of `text`, whose number in the file is `first_line`. `comment`
  /// begins a comment that runs to the end of the line; the last character of a line, where it is
  /// `continuation` and stands in no comment, makes the next one go on with it; '\0' for none.
  LineCursor(std::string name, std::string_view text, std::uint64_t first_line, char comment,
             char continuation = '\0')
      : name_(std::move(name)),
        at_(text.data()),
        end_(text.data() + text.size()),
        line_(first_line),
        comment_(comment),
        continuation_(continuation) {}

  /// Goes to the next line that holds something; false at the end of the text.
  bool next_line() {
    if (on_line_) skip_line();
    on_line_ = true;
    while (line_done()) {
      if (at_ == end_) return false;
      skip_line();
    }
    return true;
  }

  /// Goes on to the next line that holds something where the current one is done; false at the end
  /// of the text.
  bool next_word() {
    if (!on_line_) return next_line();
    return !line_done() || next_line();
  }

  /// Whether the current line holds nothing further.
  bool line_done() {
    for (;;) {
      while (at_ != end_ && (*at_ == ' ' || *at_ == '\t'))
        ++at_;
      if (at_ == end_ || !goes_on(at_)) break;
      skip_line();
    }
    return at_ == end_ || *at_ == '\n' || *at_ == '\r' || is_comment(*at_);
  }

  /// The next number of the current line, which is not done. Throws Error(asset) for another word.
  double number();
  /// The same for an integer. A number with a fraction, or beyond 64 bits, is an error.
  std::int64_t integer();
  /// The same for a vertex index: `k_bad_index` for any number that is not an integer in
  /// [0, k_bad_index).
  std::uint32_t index();
  static constexpr std::uint32_t k_bad_index = 0xffffffffU;
  static std::uint32_t to_index(double value) {
    const bool fits = value >= 0 && value < static_cast<double>(k_bad_index);
    if (!fits) return k_bad_index;
    const auto index = static_cast<std::uint32_t>(value);
    return static_cast<double>(index) == value ? index : k_bad_index;
  }

  /// The next word of the current line; empty where the line is done.
  std::string_view word();
  /// What is left of the current line, comments and all, without the blanks around it. Then it is done.
  std::string_view rest_of_line();
  /// Steps back over the last `count` characters of the word just read.
  void put_back(std::size_t count) { at_ -= count; }

  /// Whether what is left of the text, blanks passed by line_done, begins with `text`.
  bool rest_starts_with(std::string_view text) const {
    return std::string_view(at_, bytes_left()).starts_with(text);
  }
  /// What is left of the text.
  std::string_view rest() const { return {at_, bytes_left()}; }
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }
  std::uint64_t line() const { return line_; }

  /// Throws Error(asset) with path and current line.
  template <typename... Args>
  [[noreturn]] void fail_here(fmt::format_string<Args...> format, Args&&... args) const {
    fail(ErrorKind::asset, "{}:{}: {}", name_, line_,
         fmt::format(format, std::forward<Args>(args)...));
  }

 private:
  bool is_comment(char c) const { return c == comment_ && comment_ != '\0'; }
  /// Whether the line that ends behind `p` is continued.
  bool goes_on(const char* p) const {
    return *p == continuation_ && continuation_ != '\0' &&
           (p + 1 == end_ || p[1] == '\n' || p[1] == '\r');
  }
  bool is_break(const char* p) const {
    return p == end_ || *p == ' ' || *p == '\t' || *p == '\n' || *p == '\r' || is_comment(*p) ||
           goes_on(p);
  }
  void skip_line();
  [[noreturn]] void not_a(const char* wanted);

  std::string name_;
  const char* at_;
  const char* end_;
  std::uint64_t line_;
  char comment_, continuation_;
  bool on_line_ = false;  ///< false only before the first next_line
};

}  // namespace ds
