// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/sdl_reader.h"

#include <optional>

namespace ds {

/// The least and the greatest value that an input takes in each of its channels.
struct InputBounds {
  Vec3 low, high;
};
/// Of a constant, or of a texture whose constants tell it; nothing where only its pixels could, or
/// where two textures meet whose extremes may lie in different places.
std::optional<InputBounds> input_bounds(const Scene& scene, const TextureRef& ref);

/// "m.mat:3: scene.materials.body.kd: wanted numbers in [0, 1], found 255 0 0: ...", where the
/// property's value is none that its table calls physical; nothing else.
std::optional<std::string> find_unphysical(const SdlNode& node, std::string_view property,
                                           const TextureRef& value);
/// Of all inputs of a material's type, which have been read.
std::vector<std::string> find_unphysical(const SdlNode& node, const NodeType& type,
                                         const std::vector<TextureRef>& inputs);

}  // namespace ds
