// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

#include <optional>

namespace ds {

/// Mean of a texture over the surfaces whose materials, or what these are mixed of, use it straight
/// as one of their inputs, at `points` places spread over their area by a fixed sequence. Linear
/// Rec.709; a scalar stands in all three. The scene's images must be loaded. Nothing where no
/// object uses it.
std::optional<Vec3> texture_mean(const Scene& scene, int texture, int points);

/// Whether a material takes the texture straight as one of its inputs or as its emission.
bool uses_texture(const Material& material, int texture);

}  // namespace ds
