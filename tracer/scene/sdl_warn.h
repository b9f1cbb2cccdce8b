// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/properties.h"
#include "tracer/scene/scene.h"

#include <string>

namespace ds {

/// Warns of each property that stands in the file more than once. These tell whether there is one.
bool warn_of_repeats(const PropertySet& properties);
/// Warns of each input of its materials that is out of its physical range.
void warn_of_materials(const Scene& scene);
/// Whether a light or an object of it is not black.
bool gives_light(const Scene& scene);
/// Warns of an environment that can be traced and is hardly meant so:
/// objects whose material's textures read uv that their meshes do not have.
bool warn_of_environment(const Scene& environment, const std::string& name);

}  // namespace ds
