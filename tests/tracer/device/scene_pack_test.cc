// SPDX-License-Identifier: Apache-2.0
// A scene in the kernels' tables.
#include "tracer/device/scene_pack.h"

#include "tests/render/pictures.h"
#include "tracer/base/error.h"
#include "tracer/scene/sdl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace ds {
namespace {

PackedScene pack(const Scene& scene) {
  return pack_scene(scene, scene_effects(scene, Camera{}), BvhQuality::medium);
}

float number(const Words& words, std::size_t i) {
  return std::bit_cast<float>(words.words().at(i));
}

Scene lit(const std::vector<Light>& lights) {
  Scene scene;
  pictures::add_object(scene, pictures::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                       pictures::add_matte(scene, {1, 1, 1}));
  scene.lights = lights;
  return scene;
}

TEST(PackScene, ASceneWithoutTrianglesIsAnError) {
  EXPECT_THROW(pack(Scene{}), Error);
}

TEST(PackScene, TrianglesStandInTheObjectsOrder) {
  Scene scene = lit({});
  pictures::add_object(scene, pictures::box({0, 0, 1}, {1, 1, 1}), 0, 77);
  const PackedScene packed = pack(scene);
  ASSERT_EQ(packed.triangles.words().size(), 14u * kernels::k_triangle_words);
  EXPECT_EQ(first_triangles(scene), (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(packed.triangles.words()[2 * kernels::k_triangle_words + kernels::k_triangle_object],
            77u);
  EXPECT_EQ(packed.triangles.words()[kernels::k_triangle_light], k_none);
  // A mesh without normals is flat: the quad's own is +z.
  EXPECT_EQ(number(packed.triangles, kernels::k_triangle_normals + 2), 1);
}

TEST(PackScene, AMeshLightsTrianglesKnowTheirLight) {
  Scene scene = lit({pictures::point_light({0, 0, 1}, {1, 1, 1})});
  const int lamp = pictures::add_matte(scene, {0, 0, 0});
  scene.materials.back().emits = true;
  scene.materials.back().emission.constant = {1, 1, 1};
  pictures::add_object(scene, pictures::quad({0, 0, 2}, {1, 0, 0}, {0, 1, 0}), lamp);
  const PackedScene packed = pack(scene);
  const std::uint32_t light =
      packed.triangles.words()[3 * kernels::k_triangle_words + kernels::k_triangle_light];
  ASSERT_LT(light, packed.data.light_count);
  // Its area is among its parameters.
  EXPECT_EQ(number(packed.lights, light * kernels::k_light_words + kernels::k_light_parameters + 3),
            4);
}

/// Lamps and carpets under a sky, and a model of this size that stands on them.
Scene room_with(float half) {
  Scene scene = lit({pictures::image_light(0)});
  scene.images = {pictures::small_sky()};
  const int lamp = pictures::add_matte(scene, {0, 0, 0});
  scene.materials.back().emits = true;
  scene.materials.back().emission.constant = {1, 1, 1};
  pictures::add_object(scene, pictures::quad({0, 0, 2}, {1, 0, 0}, {0, 1, 0}), lamp);
  pictures::add_object(scene, pictures::quad({0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}), 0);
  pictures::add_object(scene, pictures::box({0, 0, half}, {half, half, half}), 0,
                       k_model_object_id);
  return scene;
}

TEST(PackCache, ChangesNoWord) {
  PackCache cache(std::size_t{1} << 20U);
  for (const float half : {0.1f, 0.2f, 0.1f, 3.0f}) {
    const Scene scene = room_with(half);
    const SceneEffects effects = scene_effects(scene, Camera{});
    const PackedScene alone = pack_scene(scene, effects, BvhQuality::medium);
    const PackedScene cached =
        pack_scene(scene, effects, BvhQuality::medium, k_most_bvh_width, &cache);
    EXPECT_EQ(cached.triangles.words(), alone.triangles.words()) << half;
    EXPECT_EQ(cached.tables.words(), alone.tables.words()) << half;
    EXPECT_EQ(cached.lights.words(), alone.lights.words()) << half;
    EXPECT_EQ(std::memcmp(&alone.data, &cached.data, sizeof alone.data), 0) << half;
    // The carpet covers the floor, and the model both.
    const auto flags = [&](std::size_t triangle) {
      return cached.triangles
          .words()[triangle * kernels::k_triangle_words + kernels::k_triangle_flags];
    };
    EXPECT_NE(flags(0) & kernels::k_flag_covered, 0u);
    EXPECT_NE(flags(4) & kernels::k_flag_covers, 0u);
    EXPECT_NE(flags(4) & kernels::k_flag_covered, 0u);
  }
}

TEST(PackSurfaces, AreTheTrianglesWithoutTheirLights) {
  const Scene scene = room_with(0.2f);
  const PackedScene surfaces = pack_surfaces(scene, BvhQuality::medium);
  std::vector<std::uint32_t> wanted = pack(scene).triangles.words();
  for (std::size_t i = kernels::k_triangle_light; i < wanted.size(); i += kernels::k_triangle_words)
    wanted[i] = k_none;
  EXPECT_EQ(surfaces.triangles.words(), wanted);
  EXPECT_TRUE(surfaces.tables.words().empty());
}

TEST(PackLights, OfAFewLightsEachIsACandidate) {
  const PackedScene packed =
      pack(lit({pictures::point_light({0, 0, 1}, {1, 1, 1}), pictures::constant_light({1, 1, 1}),
                pictures::sun_light({0, 0, 1}, 1, {100, 100, 100})}));
  EXPECT_EQ(packed.data.light_rounds, 3u);
  for (const std::uint32_t i : {0u, 1u, 2u})
    EXPECT_EQ(number(packed.lights, i * kernels::k_light_words + kernels::k_light_probability),
              i == 1 ? 0 : 1);
}

TEST(PackLights, OfManySelectionProbabilitiesSumToOneAndNoLightIsStarved) {
  std::vector<Light> lights = {pictures::point_light({0, 0, 1}, {1, 1, 1}),
                               pictures::point_light({0, 0, 2}, {1e6f, 1e6f, 1e6f}),
                               pictures::spot_light({0, 0, 3}, {0, 0, -1}, 30, 10, {2, 2, 2}),
                               pictures::constant_light({1, 1, 1}),
                               pictures::sun_light({0, 0, 1}, 1, {100, 100, 100})};
  const auto add = [&](int count) {
    for (int i = 0; i < count; ++i)
      lights.push_back(pictures::point_light({1, 0, 1}, {1, 1, 1}));
  };
  add(kernels::k_most_rounds - 5);
  EXPECT_EQ(pack(lit(lights)).data.light_rounds, kernels::k_most_rounds);
  add(1);
  const PackedScene packed = pack(lit(lights));
  EXPECT_EQ(packed.data.light_rounds, 1u);
  const std::uint32_t count = packed.data.light_count;
  ASSERT_EQ(count, kernels::k_most_rounds + 1u);
  double sum = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float share =
        number(packed.lights, i * kernels::k_light_words + kernels::k_light_probability);
    const float high = number(packed.tables, packed.data.light_table + i);
    sum += double{share};
    EXPECT_NEAR(double{high}, sum, 1e-6);
    if (share > 0) {
      EXPECT_GT(share, 0.49f / static_cast<float>(count));
    }
  }
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_EQ(number(packed.tables, packed.data.light_table + count - 1), 1);
  // The constant light is met, never sampled; those met stand behind those sampled only.
  EXPECT_EQ(packed.data.first_escape_light, count - 2);
}

TEST(PackLights, BlackLightsAreNotThere) {
  const PackedScene packed = pack(lit(
      {pictures::point_light({0, 0, 1}, {0, 0, 0}), pictures::point_light({0, 0, 2}, {1, 1, 1})}));
  EXPECT_EQ(packed.data.light_count, 1u);
  EXPECT_EQ(number(packed.lights, kernels::k_light_probability), 1);
}

}  // namespace
}  // namespace ds
