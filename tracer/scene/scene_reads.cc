// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/scene_reads.h"

#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <vector>

namespace ds {
namespace {

class Search {
 public:
  explicit Search(const Scene& scene) : scene_(scene), seen_(scene.textures.size(), false) {}

  void material(int index) {
    if (index < 0) return;
    const Material& m = scene_.materials[static_cast<std::size_t>(index)];
    all(m.inputs);
    texture(m.emission.texture);
    for (const int child : m.children)
      material(child);
  }
  MeshExtras found() const { return found_; }

 private:
  void all(const std::vector<TextureRef>& inputs) {
    for (const TextureRef& ref : inputs)
      texture(ref.texture);
  }
  void texture(int index) {
    if (index < 0 || seen_[static_cast<std::size_t>(index)]) return;
    seen_[static_cast<std::size_t>(index)] = true;
    const Texture& t = scene_.textures[static_cast<std::size_t>(index)];
    const NodeType& type = texture_types()[static_cast<std::size_t>(t.type)];
    found_.uvs = found_.uvs || reads_uvs(type);
    found_.colors = found_.colors || reads_colors(type);
    all(t.inputs);
  }

  const Scene& scene_;
  std::vector<bool> seen_;
  MeshExtras found_;
};

}  // namespace

MeshExtras reads_of(const Scene& scene, int material) {
  Search search(scene);
  search.material(material);
  return search.found();
}

MeshExtras reads_of_model(const Scene& material) {
  Search search(material);
  const int last = static_cast<int>(material.materials.size()) - 1;
  for (int i = material.own_materials.empty() ? last : 0; i <= last; ++i)
    search.material(i);
  return search.found();
}

std::vector<int> shown_materials(const Object& object) {
  std::vector<int> shown(object.triangle_materials.begin(), object.triangle_materials.end());
  if (shown.empty() && object.material >= 0) shown.push_back(object.material);
  std::sort(shown.begin(), shown.end());
  shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
  return shown;
}

}  // namespace ds
