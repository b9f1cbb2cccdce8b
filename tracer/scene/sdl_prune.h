// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

namespace ds {

/// The scene without the materials, textures and images that nothing uses, in an order that follows
/// from names and uses, not from the file: the order of objects and lights decides which random
/// number meets which, and what is unused must not be in the key or in the program.
Scene prune_to_last_material(Scene scene);
/// As above, from the objects and lights, which are sorted by name.
Scene prune_environment(Scene scene);

}  // namespace ds
