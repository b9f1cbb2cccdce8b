// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/device/scene_effects.h"

#include <string>
#include <vector>

namespace ds {

/// Source of the path tracer for these effects: definitions, then every kernel file it needs,
/// once, in order of inclusion. The lane count is not in it (it is the build option DS_LANES: it
/// changes no bit of a picture).
std::string path_program_text(const SceneEffects& effects);
/// What the source of a program that reads materials begins with, and the files of these: as in
/// path_program_text, for what a point's material is.
std::string material_definitions(const SceneEffects& effects);
std::vector<std::string> material_files(const SceneEffects& effects);
/// Source of single rays.
std::string rays_program_text();

}  // namespace ds
