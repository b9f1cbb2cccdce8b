// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/program_tokens.h"

#include <algorithm>
#include <array>

namespace ds {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c) || c == '_';
}
bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

/// Lines that end in a backslash joined with the next, as C's second phase of translation does.
std::string joined_lines(std::string_view source) {
  std::string text;
  text.reserve(source.size());
  while (!source.empty()) {
    const std::size_t at = std::min(source.find('\\'), source.size());
    text += source.substr(0, at);
    source.remove_prefix(at);
    if (source.starts_with("\\\n")) {
      source.remove_prefix(2);
    } else if (source.starts_with("\\\r\n")) {
      source.remove_prefix(3);
    } else if (!source.empty()) {
      text += '\\';
      source.remove_prefix(1);
    }
  }
  return text;
}

/// C's preprocessing numbers: wider than numbers, such as 1e+5f and 0x1p-3.
std::size_t number_size(std::string_view text) {
  std::size_t i = 1;
  while (i < text.size() && (is_word(text[i]) || text[i] == '.' ||
                             ((text[i] == '+' || text[i] == '-') &&
                              std::string_view("eEpP").find(text[i - 1]) != text.npos)))
    ++i;
  return i;
}

/// With both quotes; to the end of the line where the second is missing.
std::size_t literal_size(std::string_view text) {
  for (std::size_t i = 1; i < text.size() && text[i] != '\n'; ++i) {
    if (text[i] == '\\')
      ++i;
    else if (text[i] == text[0])
      return i + 1;
  }
  return std::min(text.size(), text.find('\n'));
}

std::size_t punctuator_size(std::string_view text) {
  // What most are followed by makes none longer.
  if (text.size() < 2 || std::string_view(".<>-+=&|#").find(text[1]) == std::string_view::npos)
    return 1;
  // Longest first.
  constexpr std::array<std::string_view, 23> k_long = {
      "...", "<<=", ">>=", "->", "++", "--", "<<", ">>", "<=", ">=", "==", "!=",
      "&&",  "||",  "+=",  "-=", "*=", "/=", "%=", "&=", "|=", "^=", "##"};
  const auto found = std::find_if(k_long.begin(), k_long.end(),
                                  [&](std::string_view p) { return text.starts_with(p); });
  return found == k_long.end() ? 1 : found->size();
}

std::size_t token_size(std::string_view text) {
  const char c = text[0];
  if (is_digit(c) || (c == '.' && text.size() > 1 && is_digit(text[1]))) return number_size(text);
  if (is_word(c))
    return static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_word) -
                                    text.begin());
  if (c == '"' || c == '\'') return literal_size(text);
  return punctuator_size(text);
}

class Spelling {
 public:
  explicit Spelling(std::size_t most) { text_.reserve(most); }
  void add(std::string_view token, bool starts_directive) {
    if (starts_directive) end_line();
    if (!text_.empty() && text_.back() != '\n' &&
        (spaced_ || last_is_number_ || is_word(text_.back()) == is_word(token[0])))
      text_ += ' ';
    // `#define f(x)` and `#define f (x)` are two things.
    spaced_ = last_ == "define";
    last_is_number_ = token_is_number(token);
    last_ = token;
    text_ += token;
  }
  /// The next token stands right behind the last, and that matters.
  void glue() { spaced_ = false; }
  bool after_macro_name() const { return spaced_; }
  void end_line() {
    if (!text_.empty() && text_.back() != '\n') text_ += '\n';
    spaced_ = last_is_number_ = false;
    last_ = {};
  }
  std::string take() { return std::move(text_); }

 private:
  static bool token_is_number(std::string_view token) {
    return is_digit(token[0]) || (token[0] == '.' && token.size() > 1 && is_digit(token[1]));
  }

  std::string text_;
  std::string_view last_;
  bool spaced_ = false, last_is_number_ = false;
};

}  // namespace

std::string program_tokens(std::string_view source) {
  const std::string joined = joined_lines(source);
  Spelling out(joined.size());
  bool line_start = true, directive = false;
  for (std::string_view rest = joined; !rest.empty();) {
    std::size_t size = 1;
    if (rest[0] == '\n') {
      if (directive) out.end_line();
      line_start = true;
      directive = false;
    } else if (rest.starts_with("//")) {
      size = std::min(rest.find('\n'), rest.size());
    } else if (rest.starts_with("/*")) {
      const std::size_t end = rest.find("*/", 2);
      size = end == rest.npos ? rest.size() : end + 2;
    } else if (!is_space(rest[0])) {
      size = token_size(rest);
      const bool starts = line_start && rest[0] == '#';
      directive = directive || starts;
      line_start = false;
      out.add(rest.substr(0, size), starts);
      if (out.after_macro_name() && rest.substr(size, 1) == "(") out.glue();
    }
    rest.remove_prefix(size);
  }
  out.end_line();
  return out.take();
}

}  // namespace ds
