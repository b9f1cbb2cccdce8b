// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// What a scene calls for; the program contains this and nothing else. Numbers are the positions in
/// these lists.
struct SceneEffects {
  /// Kernel prefixes, in the order of lists.h. Those that choose among other materials are numbered
  /// behind all that do not.
  std::vector<std::string> materials, choosers;
  std::vector<std::string> textures;       ///< kernel prefixes
  std::vector<std::string> lights;         ///< kernel prefixes
  std::vector<std::string> escape_lights;  ///< those of `lights` that lie beyond the scene
  bool lens = false;
  bool camera_invisible = false;  ///< an object that camera rays pass through
  bool lobe_choice = false;       ///< a material that picks one of several lobes
  bool guide = false;  ///< surfaces that receive caustics look for what the model casts (guide.h)
  int material_inputs = 1;  ///< most floats any used material's inputs take
  int texture_stack = 1;    ///< most values any texture program has on its stack at once
  std::vector<std::string>
      light_planes;       ///< traced beside the picture; scene_effects asks for none
  int chooser_depth = 0;  ///< most materials that choose on the way to one that does not

  bool operator==(const SceneEffects&) const = default;
  bool has_material(std::string_view prefix) const;
  /// Position in the list, or -1.
  static int number(const std::vector<std::string>& list, std::string_view name);
};

bool samples_lights(const SceneEffects& effects);

/// False for a light or an emitter whose radiance is 0: it is treated as if it were not there. What
/// an image or a texture holds is not looked at.
bool shines(const Light& light);
bool shines(const Material& material);

/// By material of the scene: whether it has one of these traits (kernels/traits.h), itself or in a
/// part.
std::vector<bool> materials_with(const Scene& scene, unsigned traits);

/// Of the objects' materials (and what these mix), all lights, and the camera's lens.
SceneEffects scene_effects(const Scene& scene, const Camera& camera);
/// Everything there is, in one program: the same bits, later.
SceneEffects all_effects();
/// The same for a scene with these effects; materials may choose among materials that choose, as deep as
/// the scene has it.
SceneEffects full_effects(const SceneEffects& own);

}  // namespace ds
