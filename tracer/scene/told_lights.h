// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"
#include "tracer/scene/sdl_parameters.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {

/// A light that no file holds, by what a file would say of it.
struct ToldLight {
  std::string name;  ///< of letters, digits and _ - [ ]
  std::string type;  ///< one of told_light_types()
  /// Properties of that type and their numbers, each within the property's range; of a flag 0 or 1.
  std::vector<std::pair<std::string, std::vector<double>>> values;
};

/// Types that need no file beside their numbers, in the order of the reference; how a file describes
/// each.
const std::vector<const SdlTypeRow*>& told_light_types();

/// The light that a file with these numbers would have. Throws Error(asset), all findings, each
/// "NAME.PROPERTY: wanted ...", where they do not go together.
Light make_told_light(const ToldLight& told);

/// Of lights that stand beside those of an environment; as canonical_environment of a scene of them.
std::string canonical_lights(const std::vector<Light>& lights);

}  // namespace ds
