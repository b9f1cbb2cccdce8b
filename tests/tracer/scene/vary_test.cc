// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/vary.h"

#include "tracer/scene/colour_temperature.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace ds {
namespace {

const std::filesystem::path k_environments = DS_SOURCE_DIR "/assets/environments";

TEST(Changed, AQuarterTurnMovesMeshesLightsAndWhatTexturesShow) {
  for (const char* name : {"office", "outdoor", "studio"}) {
    const Scene before = read_environment(k_environments / name);
    const Scene after = changed(before, {90, 1});
    ASSERT_EQ(before.objects.size(), after.objects.size());
    for (std::size_t i = 0; i < before.objects.size(); ++i) {
      const Mesh &mesh = before.objects[i].mesh, &turned = after.objects[i].mesh;
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        // A quarter turn takes (x, y) to (-y, x), exactly.
        const Vec3 p = mesh.positions[v];
        ASSERT_EQ(turned.positions[v], (Vec3{-p.y, p.x, p.z}));
      }
      for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        const Vec3 n = mesh.normals[v];
        ASSERT_EQ(turned.normals[v], (Vec3{-n.y, n.x, n.z}));
      }
    }
    for (std::size_t i = 0; i < before.lights.size(); ++i) {
      const Light &light = before.lights[i], &turned = after.lights[i];
      EXPECT_EQ(light.color, turned.color);
      for (const auto& input : type_of(light).host.inputs) {
        if (input.value != kernels::LightValue::point &&
            input.value != kernels::LightValue::direction)
          continue;
        const Vec3 p = light_vector(light, input.name);
        EXPECT_EQ(light_vector(turned, input.name), (Vec3{-p.y, p.x, p.z})) << input.name;
      }
      const Vec3d sight{0.3, -0.5, 0.7}, there = light.light_to_world.direction(sight);
      EXPECT_EQ(turned.light_to_world.direction(sight), (Vec3d{-there.y, there.x, there.z}));
    }
    // A texture shows at a turned point what it showed there before.
    for (std::size_t i = 0; i < before.textures.size(); ++i) {
      const Texture& texture = before.textures[i];
      if (!has_trait(texture_types()[static_cast<std::size_t>(texture.type)],
                     kernels::k_trait_position))
        continue;
      const Vec3d p{0.1, 0.2, 0.3}, there = texture.world_to_texture.point(p);
      const Vec3d turned = after.textures[i].world_to_texture.point({-p.y, p.x, p.z});
      EXPECT_LT(length(turned - there), 1e-14);
    }
  }
}

TEST(Changed, AGainIsAFactorOnEverythingThatShines) {
  const Scene before = read_environment(k_environments / "studio");
  const Scene after = changed(before, {0, 2.5});
  ASSERT_FALSE(before.lights.empty());
  for (std::size_t i = 0; i < before.lights.size(); ++i)
    EXPECT_EQ(after.lights[i].color, before.lights[i].color * 2.5F);
  Scene shining;
  Material lamp, mapped;
  lamp.name = "lamp";
  lamp.emits = mapped.emits = true;
  lamp.emission.constant = {1, 2, 4};
  mapped.name = "mapped";
  mapped.emission.texture = 0;
  Texture image;
  image.name = "image";
  image.type = find_type(texture_types(), "imagemap");
  shining.textures.push_back(image);
  shining.materials = {lamp, mapped};
  const Scene dimmed = changed(shining, {0, 0.5});
  EXPECT_EQ(dimmed.materials[0].emission.constant, (Vec3{0.5F, 1, 2}));
  ASSERT_EQ(dimmed.textures.size(), 2U);
  EXPECT_EQ(dimmed.materials[1].emission.texture, 1);
  EXPECT_EQ(dimmed.textures[1].inputs[0].texture, 0);
  EXPECT_EQ(dimmed.textures[1].inputs[1].constant, (Vec3{0.5F, 0.5F, 0.5F}));
  EXPECT_TRUE(gain_changes_program(shining));
  EXPECT_FALSE(gain_changes_program(before));
}

TEST(Changed, ATemperatureIsAFactorOnColours) {
  const Scene before = read_environment(k_environments / "studio");
  const Scene after = changed(before, {0, 2, 3000});
  const Vec3d tint = black_body_colour(3000);
  for (std::size_t i = 0; i < before.lights.size(); ++i)
    EXPECT_EQ(after.lights[i].color, to_float(to_double(before.lights[i].color) * tint * 2.0));
  EXPECT_GT(tint.x, 1.3);
  EXPECT_LT(tint.z, 0.4);
}

TEST(Changed, NothingChangesNothing) {
  const Scene before = read_environment(k_environments / "outdoor");
  EXPECT_EQ(canonical_environment(changed(before, {})), canonical_environment(before));
}

}  // namespace
}  // namespace ds
