// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/scene_effects.h"

#include "tracer/device/texture_code.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/scene_reads.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <set>
#include <span>

namespace ds {
namespace {

/// Of a material: its inputs' and its numbers.
int input_floats(const NodeType& type) {
  int floats = static_cast<int>(type.numbers.size());
  for (const InputType& input : type.inputs)
    floats += input.width;
  return floats;
}

/// Materials that objects show, and the parts of mixes among them.
std::vector<bool> used_materials(const Scene& scene) {
  std::vector<bool> used(scene.materials.size(), false);
  for (const Object& object : scene.objects)
    for (const int material : shown_materials(object))
      used[static_cast<std::size_t>(material)] = true;
  // Children stand before their parent, so one pass from the end reaches all.
  for (std::size_t i = scene.materials.size(); i-- > 0;)
    if (used[i])
      for (const int child : scene.materials[i].children)
        if (child >= 0) used[static_cast<std::size_t>(child)] = true;
  return used;
}

/// Those present, with children or without. Keeps the order of the tables, so that equal sets make
/// equal programs.
std::vector<std::string> prefixes(std::span<const NodeType> types, const std::vector<bool>& present,
                                  bool with_children = false) {
  std::vector<std::string> list;
  for (std::size_t i = 0; i < types.size(); ++i)
    if (present[i] && (types[i].children > 0) == with_children)
      list.emplace_back(types[i].kernel_prefix);
  return list;
}

/// Of each material.
std::vector<int> chooser_depths(const Scene& scene) {
  std::vector<int> depths(scene.materials.size(), 0);
  // Children stand before their parent.
  for (std::size_t i = 0; i < depths.size(); ++i)
    for (const int child : scene.materials[i].children)
      if (child >= 0) depths[i] = std::max(depths[i], depths[static_cast<std::size_t>(child)] + 1);
  return depths;
}

void add_materials(const Scene& scene, SceneEffects& effects) {
  const std::vector<int> depths = chooser_depths(scene);
  const std::vector<bool> used = used_materials(scene);
  std::vector<bool> present(material_types().size(), false);
  std::vector<bool> textures(texture_types().size(), false);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    const Material& material = scene.materials[i];
    const NodeType& type = material_types()[static_cast<std::size_t>(material.type)];
    present[static_cast<std::size_t>(material.type)] = true;
    effects.material_inputs = std::max(effects.material_inputs, input_floats(type));
    effects.chooser_depth = std::max(effects.chooser_depth, depths[i]);
    const TextureCode code = texture_code(scene, material);
    for (const int texture : code.types)
      textures[static_cast<std::size_t>(texture)] = true;
    effects.texture_stack = std::max(effects.texture_stack, code.stack);
  }
  effects.materials = prefixes(material_types(), present);
  effects.choosers = prefixes(material_types(), present, true);
  effects.textures = prefixes(texture_types(), textures);
}

/// Whether the model shows a material that casts caustics, itself or as a part.
bool model_casts_caustics(const Scene& scene) {
  const std::vector<bool> casts = materials_with(scene, kernels::k_trait_casts_caustics);
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
    const std::vector<int> shown = shown_materials(object);
    return object.id == k_model_object_id &&
           std::any_of(shown.begin(), shown.end(),
                       [&](int material) { return casts[static_cast<std::size_t>(material)]; });
  });
}

void add_light(const LightType& type, SceneEffects& effects) {
  effects.lights.emplace_back(type.kernel_prefix);
  if (has_trait(type, kernels::k_trait_beyond))
    effects.escape_lights.emplace_back(type.kernel_prefix);
}

void add_lights(const Scene& scene, SceneEffects& effects) {
  std::set<std::string_view> names;
  for (const Light& light : scene.lights)
    if (shines(light)) names.insert(type_of(light).kernel_prefix);
  for (const Object& object : scene.objects)
    if (object.material >= 0 && shines(scene.materials[static_cast<std::size_t>(object.material)]))
      names.insert("mesh");
  for (const LightType& type : light_types())
    if (names.contains(type.kernel_prefix)) add_light(type, effects);
}

/// Whether a material of the program, or a chooser, has the trait.
bool any_material(const SceneEffects& effects, unsigned trait) {
  return std::any_of(material_types().begin(), material_types().end(), [&](const NodeType& type) {
    return has_trait(type, trait) && effects.has_material(type.kernel_prefix);
  });
}

bool any_light(const SceneEffects& effects, unsigned trait) {
  return std::any_of(effects.lights.begin(), effects.lights.end(),
                     [&](const std::string& name) { return has_trait(light_type(name), trait); });
}

}  // namespace

bool samples_lights(const SceneEffects& effects) {
  return any_light(effects, kernels::k_trait_sampled);
}

std::vector<bool> materials_with(const Scene& scene, unsigned traits) {
  std::vector<bool> have(scene.materials.size(), false);
  // Children stand before their parent.
  for (std::size_t i = 0; i < have.size(); ++i) {
    const Material& material = scene.materials[i];
    have[i] = has_trait(material_types()[static_cast<std::size_t>(material.type)], traits);
    for (const int child : material.children)
      if (child >= 0 && have[static_cast<std::size_t>(child)]) have[i] = true;
  }
  return have;
}

bool shines(const Light& light) {
  return light.color.x > 0 || light.color.y > 0 || light.color.z > 0;
}

bool shines(const Material& material) {
  const Vec3 c = material.emission.constant;
  return material.emits && (material.emission.texture >= 0 || c.x > 0 || c.y > 0 || c.z > 0);
}

int SceneEffects::number(const std::vector<std::string>& list, std::string_view name) {
  const auto found = std::find(list.begin(), list.end(), name);
  return found == list.end() ? -1 : static_cast<int>(found - list.begin());
}

bool SceneEffects::has_material(std::string_view prefix) const {
  return number(materials, prefix) >= 0 || number(choosers, prefix) >= 0;
}

SceneEffects scene_effects(const Scene& scene, const Camera& camera) {
  SceneEffects effects;
  add_materials(scene, effects);
  add_lights(scene, effects);
  effects.lens = camera.lens_radius_m > 0;
  effects.camera_invisible =
      std::any_of(scene.objects.begin(), scene.objects.end(),
                  [](const Object& object) { return object.camera_invisible; });
  effects.lobe_choice = any_material(effects, kernels::k_trait_lobes);
  effects.guide = any_light(effects, kernels::k_trait_small) && model_casts_caustics(scene) &&
                  any_material(effects, kernels::k_trait_receives_caustics);
  return effects;
}

SceneEffects all_effects() {
  SceneEffects effects;
  for (const NodeType& type : material_types()) {
    (type.children > 0 ? effects.choosers : effects.materials).emplace_back(type.kernel_prefix);
    effects.material_inputs = std::max(effects.material_inputs, input_floats(type));
  }
  for (const NodeType& type : texture_types())
    effects.textures.emplace_back(type.kernel_prefix);
  for (const LightType& type : light_types())
    add_light(type, effects);
  effects.lens = effects.camera_invisible = effects.lobe_choice = effects.guide = true;
  effects.texture_stack = k_texture_stack_limit;
  return effects;
}

SceneEffects full_effects(const SceneEffects& own) {
  constexpr int k_usual_depth = 8;  // one program serves all scenes that are not deeper
  SceneEffects all = all_effects();
  all.chooser_depth = std::max(own.chooser_depth, k_usual_depth);
  return all;
}

}  // namespace ds
