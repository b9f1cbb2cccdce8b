// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/effects.h"

#include "tracer/base/error.h"
#include "tracer/device/program_text.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/scene_reads.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <set>
#include <string_view>

namespace ds {
namespace {

/// What calls for one effect, by name, each once; a long list is cut.
class Callers {
 public:
  void add(const std::string& name) {
    if (std::find(names_.begin(), names_.end(), name) == names_.end()) names_.push_back(name);
  }
  bool empty() const { return names_.empty(); }
  /// "a, b, c and 4 more"
  std::string text() const {
    constexpr std::size_t k_most = 3;
    std::string text;
    for (std::size_t i = 0; i < std::min(names_.size(), k_most); ++i)
      text += (i == 0 ? "" : ", ") + names_[i];
    if (names_.size() > k_most) text += fmt::format(" and {} more", names_.size() - k_most);
    return text;
  }

 private:
  std::vector<std::string> names_;
};

std::string named(std::string_view sort, const std::string& name) {
  return name.empty() ? std::string(sort) + " without a name" : fmt::format("{} {}", sort, name);
}

const Material& material_of(const Scene& scene, int index) {
  return scene.materials[static_cast<std::size_t>(index)];
}

/// Who calls for each row of the tables of materials and textures.
struct NodeCallers {
  std::vector<Callers> materials, textures;
};

/// Graphs share nodes: each texture is walked once for a material.
void call_textures(const Scene& scene, const std::string& caller,
                   const std::vector<TextureRef>& inputs, std::set<int>& done, NodeCallers& to) {
  for (const TextureRef& input : inputs) {
    if (input.texture < 0 || !done.insert(input.texture).second) continue;
    const Texture& texture = scene.textures[static_cast<std::size_t>(input.texture)];
    to.textures[static_cast<std::size_t>(texture.type)].add(
        fmt::format("{} of {}", named("texture", texture.name), caller));
    call_textures(scene, caller, texture.inputs, done, to);
  }
}

/// Objects may share a material by the thousand, mixes their parts: each is walked once.
void call_material(const Scene& scene, const std::string& caller, int index, std::set<int>& done,
                   NodeCallers& to) {
  if (!done.insert(index).second) return;
  const Material& material = material_of(scene, index);
  const std::string name = named("material", material.name);
  to.materials[static_cast<std::size_t>(material.type)].add(fmt::format("{} of {}", name, caller));
  std::set<int> textures;
  call_textures(scene, name, material.inputs, textures, to);
  for (const int child : material.children)
    if (child >= 0) call_material(scene, name, child, done, to);
}

NodeCallers node_callers(const Scene& scene) {
  NodeCallers callers{std::vector<Callers>(material_types().size()),
                      std::vector<Callers>(texture_types().size())};
  std::set<int> done;
  for (const Object& object : scene.objects)
    for (const int material : shown_materials(object))
      call_material(scene, named("object", object.name), material, done, callers);
  return callers;
}

class EffectList {
 public:
  void add(std::string sort, std::string_view name, bool simulated, const Callers& callers,
           std::string without) {
    DS_ASSERT(simulated != callers.empty());
    list_.push_back({std::move(sort), std::string(name), simulated,
                     simulated ? callers.text() : std::move(without)});
  }
  std::vector<Effect> take() { return std::move(list_); }

 private:
  std::vector<Effect> list_;
};

void add_nodes(const Scene& scene, const SceneEffects& f, EffectList& list) {
  const NodeCallers callers = node_callers(scene);
  for (std::size_t i = 0; i < material_types().size(); ++i) {
    const NodeType& type = material_types()[i];
    const bool simulated = f.has_material(type.kernel_prefix);
    const bool there =
        std::any_of(scene.materials.begin(), scene.materials.end(),
                    [&](const Material& material) { return material.type == static_cast<int>(i); });
    list.add("material", type.name, simulated, callers.materials[i],
             there ? "no object shows it" : "no material is of this type");
  }
  for (std::size_t i = 0; i < texture_types().size(); ++i) {
    const NodeType& type = texture_types()[i];
    const bool there =
        std::any_of(scene.textures.begin(), scene.textures.end(),
                    [&](const Texture& texture) { return texture.type == static_cast<int>(i); });
    list.add("texture", type.name, SceneEffects::number(f.textures, type.kernel_prefix) >= 0,
             callers.textures[i],
             there ? "no material that is shown uses it" : "no texture is of this type");
  }
}

/// Who calls for each kind of light of the full program.
Callers light_callers(const Scene& scene, std::string_view kind) {
  Callers callers;
  for (const Light& light : scene.lights)
    if (type_of(light).kernel_prefix == kind && shines(light))
      callers.add(named("light", light.name));
  if (kind == "mesh")
    for (const Object& object : scene.objects)
      if (object.material >= 0 && shines(material_of(scene, object.material)))
        callers.add(named("object", object.name));
  return callers;
}

/// Why a kind of light that nothing calls for is left out.
std::string why_no_light(const Scene& scene, std::string_view kind) {
  for (const Light& light : scene.lights)
    if (type_of(light).kernel_prefix == kind) return named("light", light.name) + " is black";
  if (kind != "mesh") return "no light is of this type";
  for (const Object& object : scene.objects)
    if (object.material >= 0 && material_of(scene, object.material).emits)
      return named("object", object.name) + " emits black";
  return "no object emits";
}

void add_lights(const Scene& scene, const SceneEffects& f, EffectList& list) {
  for (const std::string& kind : all_effects().lights)
    list.add("light", kind, SceneEffects::number(f.lights, kind) >= 0, light_callers(scene, kind),
             why_no_light(scene, kind));
}

void add_camera(const Scene& scene, const Camera& camera, const SceneEffects& f, EffectList& list) {
  Callers lens, invisible;
  if (camera.lens_radius_m > 0) lens.add(fmt::format("lens radius {} m", camera.lens_radius_m));
  list.add("camera", "lens", f.lens, lens, "the lens radius is 0");
  for (const Object& object : scene.objects)
    if (object.camera_invisible) invisible.add(named("object", object.name));
  list.add("camera", "camera-invisible objects", f.camera_invisible, invisible,
           "the camera sees every object");
}

void add_transport(const Scene& scene, const SceneEffects& f, EffectList& list) {
  Callers sampled, beyond, lobes, guide;
  for (const std::string& kind : f.lights)
    if (has_trait(light_type(kind), kernels::k_trait_sampled)) sampled.add(kind);
  list.add("transport", "sampling of lights", samples_lights(f), sampled,
           f.lights.empty() ? "there is no light" : "scattered rays find a constant sky as well");
  for (const std::string& kind : f.escape_lights)
    beyond.add(kind);
  list.add("transport", "light from beyond the scene", !f.escape_lights.empty(), beyond,
           "no light lies beyond the scene");
  for (const NodeType& type : material_types())
    if (has_trait(type, kernels::k_trait_lobes) && f.has_material(type.kernel_prefix))
      lobes.add(std::string(type.kernel_prefix));
  list.add("transport", "choice among lobes", f.lobe_choice, lobes,
           "every material shown has one lobe");
  for (const Object& object : scene.objects)
    if (f.guide && object.id == k_model_object_id) guide.add(named("object", object.name));
  list.add("transport", "guide to caustics", f.guide, guide,
           std::none_of(f.lights.begin(), f.lights.end(),
                        [](const std::string& kind) {
                          return has_trait(light_type(kind), kernels::k_trait_small);
                        })
               ? "no light is small"
               : "the model casts no caustics, or nothing shown receives them");
}

}  // namespace

std::vector<Effect> effects_of(const Scene& scene, const Camera& camera) {
  const SceneEffects effects = scene_effects(scene, camera);
  EffectList list;
  add_nodes(scene, effects, list);
  add_lights(scene, effects, list);
  add_camera(scene, camera, effects, list);
  add_transport(scene, effects, list);
  return list.take();
}

}  // namespace ds
