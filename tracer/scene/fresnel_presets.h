// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/sdl_reader.h"

#include <string_view>
#include <vector>

namespace ds {

/// Refractive index n and extinction k of LuxCore's named conductors for the red, green and blue of
/// linear Rec.709. Null for any other name.
const ConductorIndex* find_conductor_preset(std::string_view name);
std::vector<std::string_view> conductor_preset_names();

}  // namespace ds
