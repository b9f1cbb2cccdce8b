// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

namespace ds {

/// The last look before a scene is traced: every number that reaches the tracer is finite, every
/// position is within k_farthest_coordinate, every index is within its list, and no light or
/// emission is negative. Readers check what a file says; products of what it says (a vertex times a
/// transformation, a gain times a power) can still leave the range of floats. Throws Error(asset)
/// that names the object, texture, material, light or image and the number found.
void check_scene(const Scene& scene);

}  // namespace ds
