// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/scene/sdl.h"

#include <algorithm>
#include <cstdint>
#include <utility>

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

/// Which material each triangle has; empty where all have the same, which `same` then is.
std::vector<std::uint32_t> own_of_triangles(const Scene& material, const Mesh& mesh, int first,
                                            int& same) {
  const std::size_t count = mesh.triangles.size();
  std::vector<std::uint32_t> found(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t number = mesh.materials.empty() ? 0 : mesh.materials[i];
    const int at = number < material.own_materials.size() ? material.own_materials[number] : -1;
    DS_ASSERT(at >= 0);
    found[i] = static_cast<std::uint32_t>(first + at);
  }
  if (std::all_of(found.begin(), found.end(), [&](auto at) { return at == found.front(); })) {
    if (count > 0) same = static_cast<int>(found.front());
    found.clear();
  }
  return found;
}

}  // namespace

Scene compose(const Scene& environment, const Scene& material, Mesh mesh) {
  Scene scene = environment;
  add_object(scene, material, std::move(mesh), {});
  return scene;
}

void add_object(Scene& scene, const Scene& material, Mesh mesh, ObjectName called) {
  DS_ASSERT(!material.materials.empty());
  const bool taken = std::any_of(scene.objects.begin(), scene.objects.end(),
                                 [&](const Object& object) { return object.id == called.id; });
  if (taken)
    fail(ErrorKind::asset, "{}: its object id {} is taken by another object of the scene",
         called.name, called.id);
  const bool own = !material.own_materials.empty();
  if (own && materials_hash(mesh) != material.own_faces)
    fail(ErrorKind::asset, "the model's materials changed while the dataset was built");
  const Offsets offsets{static_cast<int>(scene.images.size()),
                        static_cast<int>(scene.textures.size()),
                        static_cast<int>(scene.materials.size())};
  scene.images.insert(scene.images.end(), material.images.begin(), material.images.end());
  for (const Texture& texture : material.textures)
    scene.textures.push_back(moved(texture, offsets));
  for (const Material& part : material.materials)
    scene.materials.push_back(moved(part, offsets));

  Object model;
  model.name = std::move(called.name);
  model.material = static_cast<int>(scene.materials.size()) - 1;
  if (own)
    model.triangle_materials = own_of_triangles(material, mesh, offsets.material, model.material);
  model.mesh = std::move(mesh);
  model.id = called.id;
  scene.objects.push_back(std::move(model));
}

}  // namespace ds
