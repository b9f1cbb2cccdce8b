// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/number_range.h"
#include "tracer/scene/sdl_names.h"
#include "tracer/scene/type_tables.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

enum class SdlType {
  number,
  flag,    ///< 0, 1, true or false
  color,   ///< three numbers, each in the range; a colour space may stand before them
  vector,  ///< three numbers
  pair,    ///< two numbers
  matrix,  ///< 16 numbers
  id,      ///< a whole number of 32 bits
  text,
  choice,        ///< one of SdlParameter::choices
  file,          ///< relative to the file that names it
  list,          ///< as many numbers as it takes
  scalar_input,  ///< a number or a texture; a colour is taken by its luminance
  color_input,   ///< one or three numbers, or a texture
};

/// One property that the reader knows: what it checks against, and what the reference is made from.
struct SdlParameter {
  std::string name;  ///< behind "scene.lights.NAME."
  SdlType type;
  std::string default_value;  ///< as a file writes it; "" where there is none
  std::string help = "";
  NumberRange range{};  ///< of every number; of an input, of its constants
  std::vector<std::string_view> choices{};
};

/// One type of light, material, ...: the properties that only it has.
struct SdlTypeRow {
  std::string name;  ///< the SDL's `type`; "" for things that have no types
  std::string help;
  std::vector<SdlParameter> parameters;
};

/// A section of an SDL file.
struct SdlSection {
  SdlKind kind;
  std::string_view topic;  ///< "materials": of `dsbuild help`
  std::string_view help;
  std::string_view default_type;
  std::vector<SdlParameter> common;  ///< what every type has
  std::vector<SdlTypeRow> types;
};

/// Each part of the reader states its own.
const SdlSection& texture_section();
const SdlSection& material_section();
const SdlSection& shape_section();
const SdlSection& object_section();
const SdlSection& light_section();
const SdlSection& film_section();

const SdlSection& sdl_section(SdlKind kind);
/// In the order of the reference.
std::vector<const SdlSection*> sdl_sections();

/// Nullptr for no such type.
const SdlTypeRow* find_type(const SdlSection& section, std::string_view type);
/// One of the row or common to all; nullptr for no such property. `row` may be null.
const SdlParameter* find_parameter(const SdlSection& section, const SdlTypeRow* row,
                                   std::string_view name);
/// Of all that the row has, common ones too, but not "type"; `row` may be null.
std::vector<std::string_view> parameter_names(const SdlSection& section, const SdlTypeRow* row);
std::vector<std::string_view> type_names(const SdlSection& section);

/// "three numbers >= 0", "linear or nearest": what a value must be.
std::string wanted_text(const SdlParameter& parameter);

/// assets/SDL.md: every section, type and property as Markdown.
std::string sdl_reference();

/// What a reference says of an input or number: its help, and of a share of light what is physical.
std::string told_text(const Parameter& told);
/// The properties of a type of material or texture that stand in its kernel header.
std::vector<SdlParameter> header_parameters(const NodeType& type);
/// The lists, one behind the other.
std::vector<SdlParameter> concatenated(std::vector<std::vector<SdlParameter>> lists);

}  // namespace ds
