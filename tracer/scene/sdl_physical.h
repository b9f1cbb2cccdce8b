// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/sdl_node.h"

#include <optional>

namespace ds {

/// "m.mat:3: scene.materials.body.kd: wanted numbers in [0, 1], found 255 0 0: ...", where the
/// value of the property `input` is none that it calls physical, whatever its images hold; nothing else.
std::optional<std::string> find_unphysical(const SdlNode& node, const Parameter& input,
                                           const TextureRef& value);
/// Of all inputs of a material, which have been read and are of that type: to its `unphysical`, or
/// where images' pixels tell it to its `of_pixels`.
void find_unphysical(const SdlNode& node, const NodeType& type, Material& material);

}  // namespace ds
