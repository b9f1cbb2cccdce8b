// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/scene/sdl.h"

namespace ds {
namespace {

/// Where the material's things start in the composed scene.
struct Offsets {
  int image = 0;
  int texture = 0;
  int material = 0;
};

void shift(int& index, int by) {
  if (index >= 0) index += by;
}

void shift(std::vector<TextureRef>& inputs, int by) {
  for (TextureRef& input : inputs)
    shift(input.texture, by);
}

Texture moved(Texture texture, const Offsets& by) {
  shift(texture.inputs, by.texture);
  shift(texture.image, by.image);
  return texture;
}

Material moved(Material material, const Offsets& by) {
  shift(material.inputs, by.texture);
  shift(material.emission.texture, by.texture);
  shift(material.children[0], by.material);
  shift(material.children[1], by.material);
  return material;
}

}  // namespace

Scene compose(const Scene& environment, const Scene& material, Mesh mesh) {
  DS_ASSERT(!material.materials.empty());
  Scene scene = environment;
  const Offsets offsets{static_cast<int>(scene.images.size()),
                        static_cast<int>(scene.textures.size()),
                        static_cast<int>(scene.materials.size())};
  scene.images.insert(scene.images.end(), material.images.begin(), material.images.end());
  for (const Texture& texture : material.textures)
    scene.textures.push_back(moved(texture, offsets));
  for (const Material& part : material.materials)
    scene.materials.push_back(moved(part, offsets));

  Object model;
  model.name = "model";
  model.mesh = std::move(mesh);
  model.material = static_cast<int>(scene.materials.size()) - 1;
  model.id = k_model_object_id;
  scene.objects.push_back(std::move(model));
  return scene;
}

}  // namespace ds
