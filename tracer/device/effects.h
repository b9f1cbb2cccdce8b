// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

#include <string>
#include <vector>

namespace ds {

/// One thing the tracer can simulate, and whether a scene's program does.
struct Effect {
  std::string sort;  ///< "material", "texture", "light", "camera", "transport"
  std::string name;  ///< "glossy2"; a material's or texture's is its SDL type
  bool simulated = false;
  std::string why;  ///< what calls for it, or that nothing does
};

/// Every effect there is, in the order of the tables: those `scene_effects` the scene and camera
/// names, with what calls for them, and those the specialised program leaves out. Needs no device.
std::vector<Effect> effects_of(const Scene& scene, const Camera& camera);

}  // namespace ds
