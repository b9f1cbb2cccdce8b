// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

namespace ds {

/// What of a mesh in this material the textures read that it, its parts and its emission are made
/// of.
MeshExtras reads_of(const Scene& scene, int material);

}  // namespace ds
