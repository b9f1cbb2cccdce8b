// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// What a scene calls for; the program contains this and nothing else. Numbers are the positions in
/// these lists.
struct Features {
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
  std::vector<std::string> light_planes;  ///< traced beside the picture; features_of asks for none
  int chooser_depth = 0;  ///< most materials that choose on the way to one that does not

  bool operator==(const Features&) const = default;
  bool has_material(std::string_view prefix) const;
  /// Position in the list, or -1.
  static int number(const std::vector<std::string>& list, std::string_view name);
};

bool samples_lights(const Features& features);

/// False for a light or an emitter whose radiance is 0: it is treated as if it were not there. What
/// an image or a texture holds is not looked at.
bool shines(const Light& light);
bool shines(const Material& material);

/// By material of the scene: whether it has one of these traits (kernels/traits.h), itself or in a
/// part.
std::vector<bool> materials_with(const Scene& scene, unsigned traits);

/// Of the objects' materials (and what these mix), all lights, and the camera's lens.
Features features_of(const Scene& scene, const Camera& camera);
/// Everything there is, in one program: the same bits, later.
Features all_features();
/// The same for a scene with these features; materials may choose among materials that choose, as deep as
/// the scene has it.
Features full_features(const Features& own);

/// Source of the path tracer for these features: definitions, then every kernel file it needs,
/// once, in order of inclusion. The lane count is not in it (it is the build option DS_LANES: it
/// changes no bit of a picture).
std::string path_program_text(const Features& features);
/// What the source of a program that reads materials begins with, and the files of these: as in
/// path_program_text, for what a point's material is.
std::string material_definitions(const Features& features);
std::vector<std::string> material_files(const Features& features);
/// Source of single rays.
std::string rays_program_text();

/// Kernel files behind definitions, their includes put in place; each file once. What they have
/// between `#ifdef DS_HOOK_...` and `#endif` is left out where the definitions lack that: it is in no
/// program, and no key, that does not ask for it.
std::string assemble(const std::string& definitions, std::span<const std::string> paths);

}  // namespace ds
