// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace ds {

/// A value of a recipe and where it was written. The only form in which TOML leaves value.cc.
struct RecipeValue {
  using Array = std::vector<RecipeValue>;
  using Table = std::map<std::string, RecipeValue, std::less<>>;

  std::variant<std::string, std::int64_t, double, bool, Array, Table> value;
  SourcePlace place;
  bool from_set = false;  ///< given by --set: paths in it are relative to the current folder

  const std::string* text() const { return std::get_if<std::string>(&value); }
  const std::int64_t* integer() const { return std::get_if<std::int64_t>(&value); }
  const bool* boolean() const { return std::get_if<bool>(&value); }
  const Array* array() const { return std::get_if<Array>(&value); }
  const Table* table() const { return std::get_if<Table>(&value); }
  Table* table() { return std::get_if<Table>(&value); }
  bool is_number() const { return value.index() == 1 || value.index() == 2; }
  /// Of an integer or a floating-point number.
  double number() const;
};

/// As TOML, on one line, in one spelling: strings in double quotes, floats the shortest that read
/// back exactly and always with a point, an exponent, inf or nan, tables with sorted keys.
std::string to_toml(const RecipeValue& value);
std::string to_toml(std::string_view text);

/// Integers as numbers: 49 becomes 49.0, inside lists and tables too.
RecipeValue with_numbers(RecipeValue value);

/// Reads a TOML document, with any line ends and with or without a byte order mark. `file` stands
/// in the places. A syntax error (or a date, which no key takes) is a finding, and then the table
/// is empty.
RecipeValue::Table parse_recipe_text(std::string_view bytes, const std::string& file,
                                     Diagnostics& diagnostics);

/// Puts "key.path=value" into `recipe`: the text behind the first "=" as a TOML value, or as a
/// string where it is none. Its place is "--set key.path". Intermediate tables are made; what stood
/// there before is replaced.
void apply_override(std::string_view assignment, RecipeValue::Table& recipe,
                    Diagnostics& diagnostics);

/// A TOML value from a text that is known to be one (a default of the key table).
RecipeValue parse_value(std::string_view text);

}  // namespace ds
