// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {

/// A float as C's hexadecimal form with no superfluous digits ("0x1.8p-1"), so that equal text
/// means equal bits. -0 is "-0x0p+0", infinities "inf" and "-inf", any NaN "nan".
std::string hex_float(float value);
std::string hex_float(double value);

/// Canonical text: one "name = value" line an entry, in the order added. The render key is the hash
/// of such texts and `explain` is the difference of two, so a name must say what it is to a person
/// ("body.kd", "fov_y_deg"). A value's line breaks are escaped, so an entry is always one line.
class CanonicalText {
 public:
  void add(std::string_view name, std::string_view value);
  void add(std::string_view name, const char* value) { add(name, std::string_view(value)); }
  void add(std::string_view name, std::int64_t value);
  void add(std::string_view name, std::uint64_t value);
  void add(std::string_view name, int value) { add(name, std::int64_t{value}); }
  void add(std::string_view name, unsigned value) { add(name, std::uint64_t{value}); }
  void add(std::string_view name, bool value) {
    add(name, std::string_view(value ? "true" : "false"));
  }
  void add(std::string_view name, float value) { add(name, hex_float(value)); }
  void add(std::string_view name, double value) { add(name, hex_float(value)); }
  /// Numbers separated by one space.
  void add(std::string_view name, std::span<const float> values);
  void add(std::string_view name, std::span<const double> values);
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// The entries of a canonical text, in order. Lines without " = " are skipped.
std::vector<std::pair<std::string, std::string>> parse_canonical(std::string_view text);

}  // namespace ds
