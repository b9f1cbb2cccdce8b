// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// LuxCore SDL property files:
///
///     line     = blank | comment | name "=" values
///     comment  = "#" as the first character of the line that is not white space, to its end
///     name     = text before the first "=", white space around it dropped
///     values   = { value }, split at spaces and tabs; none is an error
///     value    = word | '"' text '"' | "'" text "'" | "{[" base64 "]}"
///
/// A line may end in CR LF. Nothing escapes a quote: use the other kind. A later line of the same
/// name replaces the earlier one's values and keeps its position, as in LuxCore. A blob is kept as the text
/// between its brackets.
struct Property {
  std::string name;
  std::vector<std::string> values;
  SourcePlace place;  ///< of the line that counts
  bool used = false;  ///< a reader has taken it; see `PropertySet::unused`
};

/// A name that stands in several lines.
struct RepeatedProperty {
  std::string name;
  SourcePlace first, last;
};

/// The properties of one file, in the order in which their names first appear.
class PropertySet {
 public:
  /// `file` is only for messages. Findings go to `diagnostics`; the lines they are about are left
  /// out.
  static PropertySet parse(std::string_view text, const std::string& file,
                           Diagnostics& diagnostics);
  /// Reads the file. Throws Error(io) where it cannot be read.
  static PropertySet read(const std::filesystem::path& file, Diagnostics& diagnostics);

  /// Gives a name these values, whatever it had.
  void put(std::string name, std::vector<std::string> values);

  /// Null where there is none. Does not mark it used.
  const Property* find(std::string_view name) const;
  /// As `find`, and marks the property used.
  const Property* use(std::string_view name);
  /// Marks every property used whose name is `prefix` or starts with `prefix` and a dot.
  void use_all(std::string_view prefix);
  /// Puts `to` in the place of `from` in every name that starts with `from` and a dot; one that there
  /// is already keeps its values.
  void rename_prefix(std::string_view from, std::string_view to);

  /// The names that stand between `prefix.` and the next dot, each once, in order of appearance.
  std::vector<std::string> names_below(std::string_view prefix) const;
  /// First property whose name starts with `prefix.`: where the thing `prefix` is defined. Null
  /// where there is none.
  const Property* first_below(std::string_view prefix) const;
  std::vector<const Property*> unused() const;
  /// In order of their second appearance.
  const std::vector<RepeatedProperty>& repeated() const { return repeated_; }

 private:
  void set(Property property);

  void note_repeat(const Property& first, const Property& last);

  std::vector<Property> properties_;
  std::vector<RepeatedProperty> repeated_;
  std::map<std::string, std::size_t, std::less<>> index_;
};

}  // namespace ds
