// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// What a scene calls for; the program contains this and nothing else. Numbers are the positions in
/// these lists.
struct Features {
  /// Kernel prefixes, in the order of lists.h; mix is not among them.
  std::vector<std::string> materials;
  std::vector<std::string> textures;  ///< kernel prefixes
  /// "point", "spot", "mesh", "constant_infinite", "infinite", "sun".
  std::vector<std::string> lights;
  std::vector<std::string> escape_lights;  ///< those of `lights` that lie beyond the scene
  bool mix = false;
  bool lens = false;
  bool camera_invisible = false;  ///< an object that camera rays pass through
  bool lobe_choice = false;       ///< a material that picks one of several lobes, or mix
  bool guide = false;       ///< dull surfaces look for what the shiny model has gathered (guide.h)
  int material_inputs = 1;  ///< most floats any used material's inputs take
  int texture_stack = 1;    ///< most values any texture program has on its stack at once

  bool operator==(const Features&) const = default;
  /// Position in the list, or -1.
  static int number(const std::vector<std::string>& list, std::string_view name);
};

/// "point", "spot", "sun", "constant_infinite", "infinite": of its kernel header.
std::string_view light_kind_name(LightKind kind);
/// Whether next-event estimation chooses this kind of light: all but a constant sky, which
/// scattered rays find as well.
bool samples_light(std::string_view kind);
bool samples_lights(const Features& features);
/// Whether the material with this kernel prefix picks one of several lobes.
bool has_lobes(std::string_view material);

/// Whether this kind of light shines from few directions, so that what shiny things gather of it is
/// bright and small.
bool is_small_light(std::string_view kind);
/// Whether surfaces of the material with this kernel prefix gather light so that dull ones can look
/// for it, and whether they are dull.
bool is_shiny(std::string_view material);
bool is_dull(std::string_view material);

/// False for a light or an emitter whose radiance is 0: it is treated as if it were not there. What
/// an image or a texture holds is not looked at.
bool shines(const Light& light);
bool shines(const Material& material);

/// Of the objects' materials (and what these mix), all lights, and the camera's lens.
Features features_of(const Scene& scene, const Camera& camera);
/// Everything there is, in one program: the same bits, later.
Features all_features();

/// Source of the path tracer for these features: definitions, then every kernel file it needs,
/// once, in order of inclusion. The lane count is not in it (it is the build option DS_LANES: it
/// changes no bit of a picture).
std::string path_program_text(const Features& features);
/// Source of mask and depth; of single rays.
std::string geometry_program_text();
std::string rays_program_text();

/// A kernel file with its includes put in place; each file once.
std::string assemble(const std::string& definitions, std::string_view root_path);

}  // namespace ds
