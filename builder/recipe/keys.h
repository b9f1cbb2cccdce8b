// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/number_range.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

enum class KeyType {
  text,
  name,  ///< a file name: letters, digits and . _ - only, no dot in front
  path,  ///< of a file or folder
  path_list,
  text_list,
  choice,  ///< one of KeySpec::choices
  boolean,
  integer,
  integer_list,  ///< of counts
  number,        ///< an integer is one too
  point,         ///< three numbers
  quaternion,    ///< four numbers, not all 0: w, x, y, z
  point_list,
  patterns,  ///< a table of patterns of properties and what is drawn for each
  lights,    ///< a list of tables, each with keys of its own: lights.h
};

using KeyRange = NumberRange;

/// The most that a key's value decides: what becomes stale when it changes.
enum class Moves {
  images,  ///< which images there are, or which model, material and environment they show
  scene,   ///< what cameras see: pictures, masks and depths
  film,    ///< what is traced for pictures, and so pictures alone
  files,   ///< which files there are, or what is made of what was traced; of the tone map also the
           ///< film where engine.error is of the developed picture
  manifest,  ///< what the manifest says, which holds all settings
};

/// One key of a recipe. The table of these is what the reader checks against and what
/// recipes/README.md's reference is made from, so a key has one description.
struct KeySpec {
  std::string_view name;  ///< "camera.fov_deg"
  Moves moves;
  KeyType type;
  std::string_view unit;           ///< "m", "degree", "" where there is none
  std::string_view default_value;  ///< TOML; "" where there is none; "(...)": in words
  KeyRange range;                  ///< of integers, numbers and each number of a point
  /// TOML literals separated by " | ": allowed beside (choice: instead of) the type.
  std::string_view choices;
  std::string_view only_with;  ///< "camera.set = \"orbit\" | ..." or "engine.error != false":
                               ///< without effect, and so an error, otherwise
  std::string_view help;       ///< see help_of

  bool has_default() const { return !default_value.empty() && default_value.front() != '('; }
};

/// Every key, by section, in the order of the reference.
std::span<const KeySpec> recipe_keys();
/// nullptr for no key of that name.
const KeySpec* find_key(std::string_view name);

/// What it does, with what stands in a table elsewhere filled in.
std::string help_of(const KeySpec& key);
/// "a string", "an integer in [1, 16384]", "\"y\" or \"z\"": what a value must be.
std::string wanted_text(const KeySpec& key);
/// only_with, taken apart: the key it asks, and the literals that it must or must not have.
struct KeyCondition {
  std::string_view key, literals;
  bool wanted = true;  ///< false: must not
};
KeyCondition condition_of(const KeySpec& key);
/// Whether a literal (as to_toml writes it) is one of " | "-separated ones.
bool is_choice(std::string_view choices, std::string_view literal);

/// "dataset", "models", ...: in the order of the reference.
std::vector<std::string_view> recipe_sections();

/// The known name that looks most like the unknown one, or "" where none does.
std::string_view nearest_key(std::string_view unknown);

/// The reference of recipes/README.md: a Markdown table a section, of mesh formats and of planes.
std::string recipe_reference();

}  // namespace ds
