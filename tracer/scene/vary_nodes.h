// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"
#include "tracer/scene/sdl_parameters.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// A number, colour, point or direction in place of what a scene file has.
struct NodeValue {
  std::string property;  ///< "lights.warm.gain": as the file names it, behind "scene."
  Vec3d value;           ///< of one number all three alike
  int width = 1;         ///< 1 or 3 numbers

  bool operator==(const NodeValue&) const = default;
};

/// The lines of a scene file that say how its lights, textures and materials are, and which of these
/// its objects show; others are empty, so that lines keep their numbers.
std::string node_lines(std::string_view scene_text);

/// A property that a light, material or texture of a scene file may have, whether or not the file gives
/// it; of materials and textures those alone that something refers to.
struct NodeProperty {
  SdlKind kind = SdlKind::light;
  std::string node;       ///< "warm"
  std::string name;       ///< "gain", "emission.gain"
  std::string full_name;  ///< NodeValue::property
  int width = 0;          ///< 1 or 3 numbers; 0: no number, or one that only picks something
  bool colour = false;
  NumberRange range{};  ///< of each number; of shares of light the physical one
  /// What the file has, or would have by default; nothing where that is a texture.
  std::optional<Vec3d> value;
};
/// `folder` is the environment's.
std::vector<NodeProperty> node_properties(const std::string& nodes,
                                          const std::filesystem::path& folder);

/// What read_environment would give if its file had these values. Meshes, and lights that no value is of,
/// are those of `environment`, with which `nodes` was read; an object keeps the side that is out. Throws
/// Error(asset), all findings, where values do not go together, as a sun below the horizon.
Scene with_node_values(const Scene& environment, const std::string& nodes,
                       const std::filesystem::path& folder, std::span<const NodeValue> values);

}  // namespace ds
