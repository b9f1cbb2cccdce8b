// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/properties.h"

#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// The sections of an SDL file that hold named things of several types.
enum class SdlKind { texture, material, shape, object, light, film };

/// "scene.textures" and so on.
std::string_view section_of(SdlKind kind);
/// "texture" and so on, for messages.
std::string_view word_for(SdlKind kind);

/// Whether LuxCore 2.x has such a type. Tells "not supported yet" from "unknown".
bool luxcore_has_type(SdlKind kind, std::string_view type);

/// A property of LuxCore that changes nothing dsbuild renders while it has this value; "*":
/// whatever its value. Covers what is below it too.
struct NoEffect {
  SdlKind kind;
  std::string_view name;
  std::string_view value;
};
std::vector<NoEffect> no_effect_properties(SdlKind kind);

/// What a property that no reader took is.
enum class Leftover {
  no_effect,      ///< LuxCore has it, and its value changes nothing dsbuild renders: accepted
  not_supported,  ///< LuxCore has it
  unknown,
};
/// `name` is the part behind "scene.materials.NAME.".
Leftover classify_leftover(SdlKind kind, std::string_view name, const Property& property);

}  // namespace ds
