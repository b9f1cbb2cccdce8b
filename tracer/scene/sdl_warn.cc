// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_warn.h"

#include "tracer/base/log.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <algorithm>

namespace ds {
namespace {

bool is_bright(Vec3 color) {
  return color.x > 0 || color.y > 0 || color.z > 0;
}

bool gives_light(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(),
                     [](const Light& light) { return is_bright(light.color); }) ||
         std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
           const Material& material = scene.materials[static_cast<std::size_t>(object.material)];
           return material.emits &&
                  (material.emission.texture >= 0 || is_bright(material.emission.constant));
         });
}

/// Whether a texture that `reads` counts is among what a material is made of.
class Search {
 public:
  Search(const Scene& scene, bool (*reads)(const NodeType&)) : scene_(scene), reads_(reads) {}

  bool material(int index) const {
    if (index < 0) return false;
    const Material& m = scene_.materials[static_cast<std::size_t>(index)];
    return any(m.inputs) || texture(m.emission.texture) || material(m.children[0]) ||
           material(m.children[1]);
  }

 private:
  bool any(const std::vector<TextureRef>& inputs) const {
    return std::any_of(inputs.begin(), inputs.end(),
                       [this](const TextureRef& ref) { return texture(ref.texture); });
  }
  bool texture(int index) const {
    if (index < 0) return false;
    const Texture& t = scene_.textures[static_cast<std::size_t>(index)];
    return reads_(texture_types()[static_cast<std::size_t>(t.type)]) || any(t.inputs);
  }

  const Scene& scene_;
  bool (*reads_)(const NodeType&);
};

}  // namespace

void warn_of_materials(const Scene& scene) {
  for (const Material& material : scene.materials)
    for (const std::string& line : material.unphysical)
      warn(line);
}

void warn_of_environment(const Scene& environment, const std::string& name) {
  if (!gives_light(environment)) warn(fmt::format("{}: nothing in it gives light", name));
  const Search uvs(environment, reads_uvs), colors(environment, reads_colors);
  for (const Object& object : environment.objects) {
    const std::string& material =
        environment.materials[static_cast<std::size_t>(object.material)].name;
    if (object.mesh.uvs.empty() && uvs.material(object.material))
      warn(fmt::format("{}: object {} has no uv, which its material {} reads", name, object.name,
                       material));
    if (object.mesh.colors.empty() && colors.material(object.material))
      warn(fmt::format("{}: object {} has no colours but white, which its material {} reads", name,
                       object.name, material));
  }
}

}  // namespace ds
