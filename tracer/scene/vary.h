// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"
#include "tracer/scene/vary_nodes.h"

#include <vector>

namespace ds {

/// What of an environment may differ from picture to picture.
struct EnvironmentChange {
  double turn_deg = 0;  ///< about the z axis, counter-clockwise seen from above; |turn_deg| <= 1e6
  double gain = 1;      ///< factor on all its light, > 0
  /// Of a black body whose colour, of luminance 1, is a factor on all its light; in [1667, 25000], or 0: none.
  double temperature_k = 0;
  std::vector<NodeValue> values{};  ///< in place of what its scene file has, before all else

  bool operator==(const EnvironmentChange&) const = default;
};

/// The environment turned, its meshes, lights and what its textures show in the world's coordinates
/// alike, and brighter or darker: lights and what emits. The same bits on every machine; those of
/// `scene` where nothing changes. `change.values` are with_node_values' business.
Scene changed(Scene scene, const EnvironmentChange& change);

/// Whether a change of its light makes another program of it: of a texture that emits, a product.
bool gain_changes_program(const Scene& scene);
/// Whether the change is of light.
bool is_gain(const EnvironmentChange& change);

}  // namespace ds
