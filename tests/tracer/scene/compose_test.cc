// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/sdl_files_for_tests.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

namespace ds {
namespace {

using ::ds::testing::SdlFolder;

constexpr std::string_view k_two_textures =
    "scene.textures.fine.type = fbm\n"
    "scene.textures.fine.mapping.type = globalmapping3d\n"
    "scene.textures.tinted.type = scale\n"
    "scene.textures.tinted.texture1 = fine\n"
    "scene.textures.tinted.texture2 = 1 0.5 0.25\n";

Scene environment_of(const SdlFolder& folder) {
  folder.write("floor.png", "not decoded by the reader");
  return folder.environment(std::string(k_two_textures) +
                            "scene.textures.picture.file = floor.png\n"
                            "scene.materials.floor.kd = tinted\n"
                            "scene.materials.wall.kd = picture\n"
                            "scene.objects.a.vertices = 0 0 0 1 0 0 0 1 0\n"
                            "scene.objects.a.faces = 0 1 2\n"
                            "scene.objects.a.material = floor\n"
                            "scene.objects.b.vertices = 0 0 0 1 0 0 0 1 0\n"
                            "scene.objects.b.faces = 0 1 2\n"
                            "scene.objects.b.material = wall\n");
}

Scene material_of(const SdlFolder& folder) {
  folder.write("skin.png", "another one");
  Scene material = folder.material(std::string(k_two_textures) +
                                   "scene.textures.picture.file = skin.png\n"
                                   "scene.materials.base.kd = tinted\n"
                                   "scene.materials.coat.type = mirror\n"
                                   "scene.materials.coat.kr = picture\n"
                                   "scene.materials.body.type = mix\n"
                                   "scene.materials.body.material1 = base\n"
                                   "scene.materials.body.material2 = coat\n"
                                   "scene.materials.body.amount = fine\n");
  material.materials.back().emission = material.materials.front().inputs.front();
  return material;
}

Mesh triangle() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

std::string texture_name(const Scene& scene, const TextureRef& ref) {
  return ref.texture < 0 ? "" : scene.textures.at(static_cast<std::size_t>(ref.texture)).name;
}

TEST(Compose, IndicesOfTheMaterialMoveBehindTheEnvironments) {
  const SdlFolder folder;
  const Scene environment = environment_of(folder);
  const Scene material = material_of(folder);
  ASSERT_EQ(environment.textures.size(), 3u);
  ASSERT_EQ(material.textures.size(), 3u);
  const Scene scene = compose(environment, material, triangle());

  ASSERT_EQ(scene.textures.size(), 6u);
  ASSERT_EQ(scene.materials.size(), environment.materials.size() + material.materials.size());
  ASSERT_EQ(scene.images.size(), 2u);
  EXPECT_EQ(scene.images[1].file.filename(), "skin.png");

  const Object& model = scene.objects.back();
  EXPECT_EQ(model.id, k_model_object_id);
  EXPECT_EQ(model.mesh.triangles.size(), 1u);
  const Material& body = scene.materials.at(static_cast<std::size_t>(model.material));
  EXPECT_EQ(body.name, "body");
  EXPECT_EQ(texture_name(scene, body.inputs[0]), "fine");
  EXPECT_GE(body.inputs[0].texture, 3);
  EXPECT_EQ(texture_name(scene, body.emission), "tinted");
  EXPECT_GE(body.emission.texture, 3);
  const Material& base = scene.materials.at(static_cast<std::size_t>(body.children[0]));
  const Material& coat = scene.materials.at(static_cast<std::size_t>(body.children[1]));
  EXPECT_EQ(base.name, "base");
  EXPECT_EQ(coat.name, "coat");
  const Texture& picture = scene.textures.at(static_cast<std::size_t>(coat.inputs[0].texture));
  EXPECT_EQ(picture.image, 1);
  for (std::size_t i = 0; i < scene.textures.size(); ++i)
    for (const TextureRef& input : scene.textures[i].inputs)
      EXPECT_LT(input.texture, static_cast<int>(i));
}

TEST(Compose, TheEnvironmentKeepsItsIndicesAndOtherIds) {
  const SdlFolder folder;
  const Scene environment = environment_of(folder);
  const Scene scene = compose(environment, material_of(folder), triangle());
  ASSERT_EQ(scene.objects.size(), 3u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(scene.objects[i].material, environment.objects[i].material);
    EXPECT_NE(scene.objects[i].id, k_model_object_id);
  }
  EXPECT_EQ(canonical_environment(environment), canonical_environment(environment_of(folder)));
}

}  // namespace
}  // namespace ds
