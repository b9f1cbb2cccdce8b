// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_prune.h"

#include <algorithm>

namespace ds {
namespace {

/// Copies what is reached, inputs before users, each once.
class Pruner {
 public:
  explicit Pruner(Scene& from)
      : from_(from),
        images_(from.images.size(), -1),
        textures_(from.textures.size(), -1),
        materials_(from.materials.size(), -1) {}

  int image(int index) {
    return take(index, from_.images, to_.images, images_, [](Image&) {});
  }
  int texture(int index) {
    return take(index, from_.textures, to_.textures, textures_, [this](Texture& texture) {
      inputs(texture.inputs);
      texture.image = image(texture.image);
    });
  }
  int material(int index) {
    return take(index, from_.materials, to_.materials, materials_, [this](Material& material) {
      for (int& child : material.children)
        child = this->material(child);
      inputs(material.inputs);
      material.emission.texture = texture(material.emission.texture);
      for (InputOfPixels& input : material.of_pixels)
        input.value.texture = texture(input.value.texture);
    });
  }
  Scene& result() { return to_; }

 private:
  template <typename T, typename Visit>
  int take(int index, std::vector<T>& from, std::vector<T>& to, std::vector<int>& moved,
           Visit visit) {
    if (index < 0) return -1;
    const auto i = static_cast<std::size_t>(index);
    if (moved[i] >= 0) return moved[i];
    T value = std::move(from[i]);
    visit(value);
    moved[i] = static_cast<int>(to.size());
    to.push_back(std::move(value));
    return moved[i];
  }
  void inputs(std::vector<TextureRef>& refs) {
    for (TextureRef& ref : refs)
      ref.texture = texture(ref.texture);
  }

  Scene& from_;
  Scene to_;
  std::vector<int> images_, textures_, materials_;
};

template <typename T>
void sort_by_name(std::vector<T>& things) {
  std::sort(things.begin(), things.end(), [](const T& a, const T& b) { return a.name < b.name; });
}

}  // namespace

Scene prune_to_last_material(Scene scene) {
  Pruner pruner(scene);
  pruner.material(static_cast<int>(scene.materials.size()) - 1);
  return std::move(pruner.result());
}

Scene prune_environment(Scene scene) {
  sort_by_name(scene.objects);
  sort_by_name(scene.lights);
  Pruner pruner(scene);
  for (Object& object : scene.objects)
    object.material = pruner.material(object.material);
  for (Light& light : scene.lights)
    light.image = pruner.image(light.image);
  Scene& result = pruner.result();
  result.objects = std::move(scene.objects);
  result.lights = std::move(scene.lights);
  result.tone_map = scene.tone_map;
  result.mended_meshes = std::move(scene.mended_meshes);
  result.lost_faces = scene.lost_faces;
  return std::move(result);
}

}  // namespace ds
