// SPDX-License-Identifier: Apache-2.0
// Stored normals that do not agree with the winding: a normal tells a line, the triangle the side,
// and no light is lost.
#include "tests/hard/everywhere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
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

/// Light that a shading normal at the angle a from the true one sends below the surface is lost: at
/// most sin^2 (a / 2) of a matte body's, and facets of the sphere turn by its rings' angle.
double most_lost() {
  const double sine = std::sin(std::numbers::pi / k_rings / 2);
  return sine * sine;
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
      // 144 pixels of 64 samples of at most 1: 4 sigma of the mean is 0.02 at the most.
      EXPECT_LT(hard::mean_of(film), 0.5 + 1e-5);
      EXPECT_GT(hard::mean_of(film), 0.5 * (1 - most_lost()) - 1e-3);
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
    // Seen at 60 degrees at the most, so no ray is sent below a facet.
    hard::everywhere(p, [](const Film& film) { EXPECT_LT(hard::worst_difference(film, 1), 1e-5); });
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
