// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/image_material.h"

#include "builder/plan/distractors.h"
#include "builder/plan/image_scene.h"
#include "builder/recipe/vary_patterns.h"
#include "tracer/base/canonical.h"
#include "tracer/base/error.h"
#include "tracer/device/scene_effects.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/vary_material.h"

#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace ds {
namespace {

Scene varied(const Scene& material, const std::vector<VaryPattern>& patterns,
             const std::vector<Drawn>& drawn, const DrawnValues& draws) {
  std::vector<PropertyValue> values;
  for (const VaryPattern& vary : patterns)
    values.push_back({vary.pattern, vary_value(vary, drawn, draws)});
  return with_values(material, values);
}

void add_values(CanonicalText& text, const std::vector<VaryPattern>& patterns,
                const std::vector<Drawn>& drawn, const DrawnValues& draws) {
  for (const VaryPattern& vary : patterns) {
    const Vec3d value = vary_value(vary, drawn, draws);
    const double numbers[] = {value.x, value.y, value.z};
    text.add(vary.pattern, std::span<const double>(numbers));
  }
}

}  // namespace

Scene material_of(const ImageSpec& image, const Recipe& recipe, Inputs& inputs) {
  return varied(inputs.material(image), recipe.vary, recipe.drawn, image.variables->draws);
}

Scene material_of(const Distractor& distractor, const Recipe& recipe, Inputs& inputs) {
  const DistractorSettings& settings = recipe.distractors;
  return varied(material_file_of(distractor, inputs), settings.vary, settings.drawn,
                distractor.draws);
}

std::string canonical_vary(const ImageSpec& image, const Recipe& recipe) {
  CanonicalText text;
  add_values(text, recipe.vary, recipe.drawn, image.variables->draws);
  return text.text();
}

std::string canonical_vary(const Distractor& distractor, const Recipe& recipe) {
  CanonicalText text;
  add_values(text, recipe.distractors.vary, recipe.distractors.drawn, distractor.draws);
  return text.text();
}

namespace {

void check_patterns(std::string_view key, const std::vector<VaryPattern>& patterns,
                    const std::vector<Drawn>& drawn, const Recipe& recipe, Inputs& inputs,
                    Diagnostics& diagnostics) {
  for (const VaryPattern& vary : patterns) {
    bool any = false;
    for (const std::filesystem::path& file : recipe.materials) {
      const PropertyFit fit = fit_of(inputs.material(file), vary.pattern);
      any = any || fit.count > 0;
      if (fit.flag)
        diagnostics.add(vary.value.place, "{} {:?} names a switch of {}, which is not drawn", key,
                        vary.pattern, file.filename().string());
      if (fit.count > 0 && !fit.colour && drawn[vary.drawn].distribution.kind == DrawnKind::colour)
        diagnostics.add(vary.value.place,
                        "{} {:?} is one number in {}, and a colour is drawn for it", key,
                        vary.pattern, file.filename().string());
      if (fit.count == 0 && !vary.optional)
        diagnostics.add(vary.value.place,
                        "{} {:?} must name a property of each material, found none in {}; with a ? "
                        "behind it such a material is left as it is",
                        key, vary.pattern, file.filename().string());
    }
    if (!any && vary.optional)
      diagnostics.add(vary.value.place, "{} {:?} names no property of any material", key,
                      vary.pattern + "?");
  }
}

}  // namespace

void check_vary(const Recipe& recipe, Inputs& inputs) {
  Diagnostics diagnostics(ErrorKind::recipe);
  check_patterns("materials.vary", recipe.vary, recipe.drawn, recipe, inputs, diagnostics);
  const DistractorSettings& distractors = recipe.distractors;
  check_patterns("distractors.vary", distractors.vary, distractors.drawn, recipe, inputs,
                 diagnostics);
  diagnostics.throw_if_any();
}

namespace {

/// Stands for the model where only the kinds of effects in a scene matter: a triangle of each of its own materials,
/// where it shows these.
Mesh stand_in(Scene& material) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  if (material.own_materials.empty()) mesh.triangles = {{0, 1, 2}};
  for (std::uint32_t number = 0; number < material.own_materials.size(); ++number) {
    if (material.own_materials[number] < 0) continue;
    mesh.triangles.push_back({0, 1, 2});
    mesh.materials.push_back(number);
  }
  material.own_faces = materials_hash(mesh);
  return mesh;
}

}  // namespace

/// What tells of the model's ids in the plane material_id: its own materials' are their numbers.
std::string ids_of_model(const Scene& material) {
  return material.own_materials.empty() ? fmt::format("{}", material.materials.back().id)
                                        : "of faces " + material.own_faces.hex();
}

Hash128 program_name_of(const Scene& material) {
  DS_ASSERT(!material.own_materials.empty());
  Scene own = material;
  Mesh model = stand_in(own);
  const SceneEffects effects = scene_effects(compose(Scene{}, own, std::move(model)), Camera{});
  return hash_text(fmt::format("own {} {} {}", fmt::join(effects.materials, " "),
                               effects.texture_stack, fmt::join(effects.textures, " ")));
}

Hash128 program_share_of(const Scene& material) {
  Scene own = material;
  Mesh model = stand_in(own);
  const SceneEffects f = scene_effects(compose(Scene{}, own, std::move(model)), Camera{});
  return hash_text(fmt::format("share {}\n{}\n{}\n{}\n{} {} {}", fmt::join(f.materials, " "),
                               fmt::join(f.choosers, " "), fmt::join(f.textures, " "),
                               fmt::join(f.lights, " "), f.material_inputs, f.texture_stack,
                               f.chooser_depth));
}

namespace {

/// What a program depends on of an environment: no mesh and no pixel, which are large.
Scene without_meshes(const Scene& environment) {
  Scene scene;
  scene.textures = environment.textures;
  scene.materials = environment.materials;
  scene.lights = environment.lights;
  for (const Image& image : environment.images) {
    Image& copy = scene.images.emplace_back();
    copy.file = image.file;
    copy.content = image.content;
  }
  for (const Object& object : environment.objects)
    scene.objects.push_back({object.name,
                             {},
                             object.material,
                             object.triangle_materials,
                             object.id,
                             object.camera_invisible});
  return scene;
}

}  // namespace

Scene scene_without_model(const Recipe& recipe, Inputs& inputs, const ImageSpec& image) {
  EnvironmentChange change = change_of(image, recipe, inputs);
  change.turn_deg = 0;
  const std::filesystem::path& folder = image.environment_folder;
  Scene scene = without_meshes(inputs.environment(folder));
  if (!change.values.empty())
    scene = with_node_values(scene, inputs.environment_facts(folder).nodes, folder, change.values);
  scene = changed(std::move(scene), change);
  scene.lights.insert(scene.lights.end(), image.lights->begin(), image.lights->end());
  for (const Distractor& one : *image.distractors) {
    Scene material = material_of(one, recipe, inputs);
    Mesh mesh = stand_in(material);
    add_object(scene, material, std::move(mesh), {one.id(), distractor_name(one)});
  }
  Scene material = material_of(image, recipe, inputs);
  Mesh model = stand_in(material);
  add_object(scene, material, std::move(model), {});
  return scene;
}

}  // namespace ds
