// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

#include <cstddef>
#include <vector>

namespace ds {

/// What of a mesh in this material the textures read that it, its parts and its emission are made
/// of.
MeshExtras reads_of(const Scene& scene, int material);
/// Of a model in a material's scene: in its last material, or all of the model's own.
MeshExtras reads_of_model(const Scene& material);

/// The materials that some triangle of an object has, each once, by index; none where it has none.
std::vector<int> shown_materials(const Object& object);
/// Of one triangle: -1 where the object has none.
inline int material_of_triangle(const Object& object, std::size_t triangle) {
  return object.triangle_materials.empty() ? object.material
                                           : static_cast<int>(object.triangle_materials[triangle]);
}

}  // namespace ds
