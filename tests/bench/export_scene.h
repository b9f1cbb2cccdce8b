// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/render.h"

#include <filesystem>

namespace ds {

/// Writes what the peers need to render the same picture:
/// - `model.ply`: the object of k_model_object_id, binary little endian, with normals;
/// - `object-N.ply`: every object, in the scene's order;
/// - `object-N.INPUT.f32`: for each textured input of object N's material the texture's value at
///   every vertex, three float32 each;
/// - `image-N.f32`: pixels of the images that lights use, float32 r g b, row 0 at the top;
/// - `scene.json`: camera, engine settings, materials, objects and lights, numbers as in
/// scene/scene.h.
///
/// Images must be loaded. Throws Error(asset) for image textures (nothing to look them up with
/// stands here) and Error(io).
void export_scene(const Scene& scene, const Camera& camera, const EngineSettings& engine,
                  const std::filesystem::path& folder);

}  // namespace ds
