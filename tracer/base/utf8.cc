// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/utf8.h"

#include "tracer/base/text_lines.h"

#include <cstdint>

namespace ds {
namespace {

constexpr char32_t k_replacement = 0xfffd;

/// Of bytes 0x80 to 0x9f; the five that have none are the control characters of ISO 8859-1.
constexpr char16_t k_windows_1252[32] = {
    0x20ac, 0x0081, 0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021, 0x02c6, 0x2030, 0x0160,
    0x2039, 0x0152, 0x008d, 0x017d, 0x008f, 0x0090, 0x2018, 0x2019, 0x201c, 0x201d, 0x2022,
    0x2013, 0x2014, 0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0x009d, 0x017e, 0x0178};

void append(std::string& text, char32_t character) {
  const auto tail = [&](unsigned shift) {
    text += static_cast<char>(0x80U | ((character >> shift) & 0x3fU));
  };
  if (character < 0x80) {
    text += static_cast<char>(character);
  } else if (character < 0x800) {
    text += static_cast<char>(0xc0U | (character >> 6U));
    tail(0);
  } else if (character < 0x10000) {
    text += static_cast<char>(0xe0U | (character >> 12U));
    tail(6);
    tail(0);
  } else {
    text += static_cast<char>(0xf0U | (character >> 18U));
    tail(12);
    tail(6);
    tail(0);
  }
}

std::string from_windows_1252(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<std::uint8_t>(c);
    append(text,
           byte >= 0x80 && byte < 0xa0 ? char32_t{k_windows_1252[byte - 0x80]} : char32_t{byte});
  }
  return text;
}

/// `first`: where in each pair the higher byte stands.
std::string from_utf16(std::string_view bytes, std::size_t first) {
  const auto unit = [&](std::size_t i) {
    const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(bytes[at]); };
    return static_cast<char32_t>((byte(i + first) << 8U) | byte(i + 1 - first));
  };
  const auto is_high = [](char32_t c) { return c >= 0xd800 && c < 0xdc00; };
  const auto is_low = [](char32_t c) { return c >= 0xdc00 && c < 0xe000; };
  std::string text;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const char32_t one = unit(i);
    if (is_high(one) && i + 3 < bytes.size() && is_low(unit(i + 2))) {
      append(text, 0x10000 + ((one - 0xd800) << 10U) + (unit(i + 2) - 0xdc00));
      i += 2;
    } else {
      append(text, is_high(one) || is_low(one) ? k_replacement : one);
    }
  }
  return text;
}

/// Bytes of the well-formed character that the text, which is not empty, begins with; else 0.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<std::uint8_t>(text[i]) : std::uint8_t{0};
  };
  const auto is_tail = [&](std::size_t i) { return (byte(i) & 0xc0U) == 0x80U; };
  const std::uint8_t head = byte(0), second = byte(1);
  if (head < 0x80) return 1;
  if (head >= 0xc2 && head < 0xe0) return is_tail(1) ? 2 : 0;
  if (head >= 0xe0 && head < 0xf0) {
    const bool odd = (head == 0xe0 && second < 0xa0) || (head == 0xed && second >= 0xa0);
    return is_tail(1) && is_tail(2) && !odd ? 3 : 0;
  }
  if (head >= 0xf0 && head < 0xf5) {
    const bool odd = (head == 0xf0 && second < 0x90) || (head == 0xf4 && second >= 0x90);
    return is_tail(1) && is_tail(2) && is_tail(3) && !odd ? 4 : 0;
  }
  return 0;
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

bool check_utf8(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  if (is_utf16(text)) {
    diagnostics.add({file}, "{}", k_utf16_message);
    return false;
  }
  for (int line = 1; !text.empty(); ++line) {
    if (is_utf8(take_line(text))) continue;
    diagnostics.add({file, line, 0}, "must be UTF-8, found bytes that are none");
    return false;
  }
  return true;
}

std::string utf8_of(std::string_view bytes) {
  if (bytes.starts_with("\xff\xfe")) return from_utf16(bytes.substr(2), 1);
  if (bytes.starts_with("\xfe\xff")) return from_utf16(bytes.substr(2), 0);
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  return is_utf8(bytes) ? std::string(bytes) : from_windows_1252(bytes);
}

}  // namespace ds
