// SPDX-License-Identifier: Apache-2.0
// Stored normals that do not agree with the winding: a normal tells a line, the triangle the side,
// and no light is lost.
#include "tests/hard/everywhere.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <utility>

namespace ds {
namespace {

using pictures::Picture;

constexpr int k_rings = 48;

/// A smooth sphere that fills the picture, under a sky of 1.
Picture near_sphere(const std::string& name) {
  Picture p = hard::deep_picture(12, 64);
  p.name = name;
  pictures::add_object(p.scene, pictures::sphere({}, 1, k_rings, true), 0);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  p.camera.position = {0.6, -1.7, 0.8};
  p.camera.fov_deg = 20;
  return p;
}

Mesh with_normals_against(Mesh mesh, std::size_t step) {
  for (std::size_t i = 0; i < mesh.normals.size(); i += step)
    mesh.normals[i] = -mesh.normals[i];
  return mesh;
}

Mesh with_winding_against(Mesh mesh, std::size_t step) {
  for (std::size_t i = 0; i < mesh.triangles.size(); i += step)
    std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  return mesh;
}

TEST(StoredNormals, AgainstTheWindingAreTheSameBits) {
  // All of them, or every third vertex': of every material, glass included, whose sides are the
  // winding's.
  for (const std::string& material : hard::materials(true)) {
    Picture p = near_sphere(material);
    p.scene.objects[0].material = hard::add_material(p.scene, material);
    const Mesh sphere = p.scene.objects[0].mesh;
    for (const hard::Way& way : hard::full_program_ways()) {
      p.scene.objects[0].mesh = sphere;
      const Film right = hard::trace(p, way);
      EXPECT_GT(hard::mean_of(right), 0.1) << material;
      for (const std::size_t step : {1u, 3u}) {
        p.scene.objects[0].mesh = with_normals_against(sphere, step);
        EXPECT_EQ(hard::trace(p, way).rgb, right.rgb)
            << material << ", one in " << step << ", " << way.name();
      }
    }
  }
}

TEST(StoredNormals, LoseNoLightOfAMatteBody) {
  // Convex, of albedo 0.5: radiance is 0.5. Half of the light was lost.
  for (const std::size_t step : {1u, 2u, 3u}) {
    Picture p = near_sphere("grey, wound against its normals, one face in " + std::to_string(step));
    pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f});
    p.scene.objects[0].mesh = with_winding_against(p.scene.objects[0].mesh, step);
    hard::everywhere(p, [](const Film& film) {
      // No noise either: each sample brings the albedo.
      EXPECT_LT(hard::worst_difference(film, 0.5), 1e-5);
    });
  }
}

TEST(StoredNormals, LoseNoLightOfAMirror) {
  for (const std::size_t step : {1u, 2u, 3u}) {
    Picture p =
        near_sphere("mirror, wound against its normals, one face in " + std::to_string(step));
    const int mirror = pictures::add_material(p.scene, "mirror");
    pictures::set_input(p.scene, mirror, "kr", {1, 1, 1});
    p.scene.objects[0].mesh = with_winding_against(p.scene.objects[0].mesh, step);
    hard::everywhere(p, [](const Film& film) { EXPECT_LT(hard::worst_difference(film, 1), 1e-5); });
  }
}

/// A square of two metres in the plane z = 0, whose normals lean to the viewer (`lean` < 0) or
/// away, seen from 10 degrees above.
Picture leaning_facet(const std::string& type, float lean, int size, int spp) {
  Picture p = hard::deep_picture(size, spp);
  p.name = type + fmt::format(", normals lean by {}", lean);
  hard::add_material(p.scene, type);
  Mesh facet = pictures::quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  facet.normals.assign(4, normalized(Vec3{0, lean, 0.77f}));
  pictures::add_object(p.scene, facet, static_cast<int>(p.scene.materials.size()) - 1);
  p.camera.position = {0, -1.97, 0.35};
  p.camera.fov_deg = 8;
  return p;
}

TEST(StoredNormals, FarFromTheTrueOnesLoseNoLightAtAGrazingView) {
  // 40 degrees: up to half of what the lobes send up would go into the facet.
  for (const float lean : {-0.64f, 0.64f})
    for (const auto& [type, input] : {std::pair{"matte", "kd"}, {"mirror", "kr"}}) {
      Picture p = leaning_facet(type, lean, 8, 16);
      pictures::set_input(p.scene, 0, input, {1, 1, 1});
      p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
      hard::everywhere(p,
                       [](const Film& film) { EXPECT_LT(hard::worst_difference(film, 1), 1e-5); });
    }
}

TEST(StoredNormals, AreWeighedAlikeWhicheverWayLightIsFound) {
  // A sky of 1 as a light that only the BSDF's directions find, and as an image that is sampled as
  // well: mirrored directions have the density and the value that they are weighed by.
  for (const float lean : {-0.64f, 0.64f})
    for (const char* type : {"matte", "glossy2", "metal2"}) {
      Picture p = leaning_facet(type, lean, 8, 1024);
      for (const char* input : {"uroughness", "vroughness"})
        if (find_input(material_types()[static_cast<std::size_t>(p.scene.materials[0].type)],
                       input) >= 0)
          pictures::set_input(p.scene, 0, input, {0.6f, 0.6f, 0.6f});
      Picture sampled = p;
      p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
      Image ones;
      ones.width = 8;
      ones.height = 4;
      ones.rgb.assign(96, 1.0f);
      sampled.scene.images.push_back(ones);
      sampled.scene.lights.push_back(pictures::image_light(0));
      for (const hard::Way& way : hard::full_program_ways()) {
        const double right = hard::mean_of(hard::trace(p, way));
        EXPECT_NEAR(hard::mean_of(hard::trace(sampled, way)), right, 2e-3 * right) << p.name;
      }
    }
}

TEST(StoredNormals, OfEnvironmentsAndEmittersToo) {
  // A lamp shines from the front of its triangles, whatever normals it has; a floor is lit on the
  // side that is seen.
  Picture p = hard::deep_picture(12, 256);
  p.name = "lamp and floor";
  p.engine.depth_total = 1;
  const int lamp = pictures::add_matte(p.scene, {0, 0, 0});
  p.scene.materials.back().emits = true;
  p.scene.materials.back().emission.constant = {4, 4, 4};
  const int grey = pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f});
  Mesh down = pictures::quad({0, 0, 2}, {0, 0.5f, 0}, {0.5f, 0, 0});
  Mesh floor = pictures::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  pictures::add_object(p.scene, down, lamp);
  pictures::add_object(p.scene, floor, grey);
  p.camera.position = {0, -1.5, 1};
  p.camera.fov_deg = 30;
  const Film right = hard::trace(p, {});
  EXPECT_GT(hard::mean_of(right), 0.05);
  p.scene.objects[0].mesh.normals.assign(4, {0, 0, 1});
  p.scene.objects[1].mesh.normals.assign(4, {0, 0, -1});
  hard::everywhere(p, [&](const Film& film) {
    EXPECT_NEAR(hard::mean_of(film), hard::mean_of(right), 1e-4 * hard::mean_of(right));
  });
  EXPECT_EQ(hard::trace(p, {}).rgb, right.rgb);
}

}  // namespace
}  // namespace ds
