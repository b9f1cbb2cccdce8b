// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/program_text.h"

#include "tracer/device/plane_types.h"
#include "tracer/device/program_assembly.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <span>
#include <string_view>

namespace ds {
namespace {

/// "#define NAME(X) X(a, 0) X(b, 1)"
std::string list_definition(std::string_view name, const std::vector<std::string>& entries,
                            const std::vector<std::string>& numbers_from) {
  std::string text = fmt::format("#define {}(X)", name);
  for (const std::string& entry : entries)
    text += fmt::format(" X({}, {})", entry, SceneEffects::number(numbers_from, entry));
  return text + "\n";
}

/// "#define NAME(type) (((type) == 0u) | ((type) == 2u))": whether a point's material, which is no
/// chooser, has the trait. Nothing where none of the program has.
std::string trait_definition(std::string_view name, const SceneEffects& effects, unsigned trait) {
  std::string any;
  for (const NodeType& type : material_types())
    if (const int number = SceneEffects::number(effects.materials, type.kernel_prefix);
        number >= 0 && has_trait(type, trait))
      any += fmt::format("{}((type) == {}u)", any.empty() ? "" : " | ", number);
  return any.empty() ? "" : fmt::format("#define {}(type) ({})\n", name, any);
}

/// Of materials and textures.
std::string material_list(const SceneEffects& effects) {
  std::string text = list_definition("DS_MATERIALS", effects.materials, effects.materials);
  if (effects.textures.empty()) return text;
  text += list_definition("DS_TEXTURES", effects.textures, effects.textures);
  return text + fmt::format("#define DS_TEXTURE_STACK {}\n", effects.texture_stack);
}

std::string input_definition(const SceneEffects& effects) {
  return fmt::format("#define DS_MATERIAL_INPUTS {}\n", effects.material_inputs);
}

std::string light_plane_list(const SceneEffects& effects) {
  if (effects.light_planes.empty()) return "";
  std::vector<std::string> covering;
  for (const std::string& name : effects.light_planes)
    if ((plane_type(name).traits & kernels::k_plane_coverage) != 0) covering.push_back(name);
  std::string text = "#define DS_HOOK_LIGHT_PLANES\n" +
                     list_definition("DS_LIGHT_PLANES", effects.light_planes, effects.light_planes);
  if (!covering.empty())
    text += list_definition("DS_COVERAGE_PLANES", covering, effects.light_planes);
  return text + fmt::format("#define DS_LIGHT_PLANE_COUNT {}\n", effects.light_planes.size());
}

std::string chooser_list(const SceneEffects& effects) {
  if (effects.choosers.empty()) return "";
  std::vector<std::string> all = effects.materials;
  all.insert(all.end(), effects.choosers.begin(), effects.choosers.end());
  return list_definition("DS_CHOOSERS", effects.choosers, all) +
         fmt::format("#define DS_FIRST_CHOOSER {}\n", effects.materials.size());
}

}  // namespace

std::string material_definitions(const SceneEffects& effects) {
  return material_list(effects) + input_definition(effects) + chooser_list(effects) +
         fmt::format("#define DS_CHOOSER_DEPTH {}\n", effects.chooser_depth);
}

std::vector<std::string> material_files(const SceneEffects& effects) {
  std::vector<std::string> paths;
  for (const std::string& name : effects.textures)
    paths.push_back(fmt::format("tracer/kernels/textures/{}.h", name));
  for (const auto* list : {&effects.materials, &effects.choosers})
    for (const std::string& name : *list)
      paths.push_back(fmt::format("tracer/kernels/materials/{}.h", name));
  return paths;
}

std::string path_program_text(const SceneEffects& effects) {
  std::string head = material_list(effects);
  if (!effects.lights.empty()) head += list_definition("DS_LIGHTS", effects.lights, effects.lights);
  if (!effects.escape_lights.empty())
    head += list_definition("DS_ESCAPE_LIGHTS", effects.escape_lights, effects.lights);
  head += input_definition(effects);
  // Alone, a constant sky needs no next-event estimation at all.
  if (samples_lights(effects)) head += "#define DS_LIGHTS_SAMPLED\n";
  if (SceneEffects::number(effects.lights, "mesh") >= 0) head += "#define DS_MESH_LIGHTS\n";
  head += chooser_list(effects);
  if (effects.lens) head += "#define DS_LENS\n";
  if (effects.camera_invisible) head += "#define DS_CAMERA_INVISIBLE\n";
  if (effects.lobe_choice) head += "#define DS_LOBE_CHOICE\n";
  head += trait_definition("DS_TRANSMITS", effects, kernels::k_trait_transmits);
  if (effects.guide)
    head += trait_definition("DS_GUIDED", effects, kernels::k_trait_receives_caustics);
  head += light_plane_list(effects);

  std::vector<std::string> paths = material_files(effects);
  for (const std::string& name : effects.lights)
    paths.push_back(fmt::format("tracer/kernels/lights/{}.h", name));
  for (const std::string& name : effects.light_planes)
    paths.push_back(fmt::format("tracer/kernels/planes/{}.h", name));
  paths.emplace_back("tracer/kernels/path.cl");
  return assemble(head, paths);
}

std::string rays_program_text() {
  const std::string path = "tracer/kernels/rays.cl";
  return assemble("", std::span(&path, 1));
}

}  // namespace ds
