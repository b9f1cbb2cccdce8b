// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/distribution.h"
#include "builder/recipe/keys.h"
#include "builder/recipe/value.h"
#include "tracer/base/error.h"

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// Whether the value is as its key wants it.
bool fits(const KeySpec& key, const RecipeValue& value);

/// The keys of one recipe, checked against the key table, with defaults behind them. Findings are
/// collected; a value with a finding counts as given and reads as the default, so that the rest of
/// the recipe is checked too.
class Settings {
 public:
  /// `file`: the recipe, for places and for relative paths. `tree` is what it holds after every
  /// --set.
  Settings(const std::filesystem::path& file, RecipeValue::Table tree, Diagnostics& diagnostics);

  /// Whether the recipe or --set names the key, right or wrong.
  bool given(std::string_view key) const { return values_.contains(key) || wrong_.contains(key); }
  /// Whether the value that they give the key has a finding, so that it reads as the default.
  bool wrong(std::string_view key) const { return wrong_.contains(key); }
  bool given_by_set(std::string_view key) const;
  /// The value given or the default; nullptr where there is neither.
  const RecipeValue* find(std::string_view key) const;
  /// Where the value given is one; nullptr where not.
  const Distribution* distribution(std::string_view key) const;
  /// Whether a misspelt key was most likely meant for this one.
  bool misspelt(std::string_view key) const { return meant_.contains(key); }
  /// Whether a key was found to have no effect with the value that this one has.
  bool misfits(std::string_view key) const { return misfits_.contains(key); }
  /// As if the key were not given.
  void unset(std::string_view key);
  /// Whether the key's only_with holds, so that it has an effect.
  bool applies(const KeySpec& key) const;

  // For keys that have a default and no distribution. Numbers are finite and in range, choices one of the allowed.
  const std::string& text(std::string_view key) const;
  double number(std::string_view key) const;
  int integer(std::string_view key) const;
  bool boolean(std::string_view key) const;
  /// A literal as a choice names it: "\"mass\"", "false".
  std::string literal(std::string_view key) const;

  /// Relative paths start at the recipe's folder, those of --set at the current one. Absolute,
  /// without "." and "..", and without a slash at the end.
  std::filesystem::path resolve(const RecipeValue& path) const {
    return resolve(path, *path.text());
  }
  std::filesystem::path resolve(const RecipeValue& giver, const std::string& path) const;

  /// A finding about a key (or an element of its list) at the place of `value`.
  void complain(const RecipeValue& value, std::string_view key, std::string_view message) const;
  /// A finding about a key, at its value's place, or about the recipe as a whole where the key is
  /// not given; none where it is misspelt.
  void complain(std::string_view key, std::string_view message) const;
  Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  void collect(const std::string& prefix, RecipeValue::Table& table,
               std::vector<std::pair<std::string, RecipeValue>>& found);
  void check(const std::string& name, RecipeValue value);
  void complain_of_unknown(const std::string& name, const RecipeValue& value);
  std::string section_meant(const std::string& name, const RecipeValue& table);
  void check_effects();

  std::string file_;
  std::filesystem::path folder_;
  std::map<std::string, RecipeValue, std::less<>> values_, wrong_;
  std::map<std::string, Distribution, std::less<>> distributions_;  ///< of some of values_
  /// Keys that a misspelt one was most likely meant for: what is amiss for want of them is no
  /// finding of its own.
  std::set<std::string, std::less<>> meant_;
  std::set<std::string, std::less<>> misfits_;
  std::map<std::string, RecipeValue, std::less<>> defaults_;
  Diagnostics& diagnostics_;
};

}  // namespace ds
