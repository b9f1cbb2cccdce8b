// SPDX-License-Identifier: Apache-2.0
// Meshes as they should not be, and cameras where they should not stand: closed forms all the same.
#include "tests/hard/everywhere.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace ds {
namespace {

using pictures::Picture;

/// A white sphere under a sky of 1, which nothing but an error can make visible.
Picture white_sphere(const std::string& name, bool smooth = false) {
  Picture p = hard::deep_picture(12, 16);
  p.name = name;
  const int white = pictures::add_matte(p.scene, {1, 1, 1});
  pictures::add_object(p.scene, pictures::sphere({}, 1, 12, smooth), white);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  p.camera.position = {0.6, -2.4, 0.8};
  p.camera.fov_deg = 45;
  return p;
}

/// The picture with its first object's triangles dealt out to these materials.
Picture patched(Picture p, const std::vector<int>& materials) {
  const Mesh mesh = p.scene.objects[0].mesh;
  p.scene.objects.erase(p.scene.objects.begin());
  hard::add_patches(p.scene, mesh, materials);
  return p;
}

/// With the sphere of white matte, mirror and a mix of them, which give back all of each sample;
/// and of every white material, of which the rough ones do so on the average.
void expect_unseen(const Picture& p) {
  Picture exact = p;
  const int mirror = pictures::add_material(exact.scene, "mirror");
  const int mix = hard::add_mix(exact.scene, 0, mirror);
  hard::everywhere(patched(exact, {0, mirror, mix}),
                   [](const Film& film) { EXPECT_LT(hard::worst_difference(film, 1), 1e-5); });
  Picture rough = p;
  const std::vector<int> all = hard::add_white_materials(rough.scene, 0.3f, 0.3f);
  hard::everywhere(patched(rough, all), [](const Film& film) {
    // The fits' 0.022 of multiple_scattering_test.cc for two materials of five, once or twice.
    EXPECT_NEAR(hard::mean_of(film), 1, 0.02);
  });
}

TEST(Geometry, TrianglesWithoutAreaCannotBeSeen) {
  Picture p = white_sphere("with points and lines");
  std::mt19937 random(1);
  Mesh& mesh = p.scene.objects[0].mesh;
  const std::size_t sound = mesh.triangles.size();
  for (int i = 0; i < 200; ++i) {
    const std::array<std::uint32_t, 3> t = mesh.triangles[random() % sound];
    mesh.triangles.push_back(i % 2 == 0 ? std::array{t[0], t[0], t[0]}
                                        : std::array{t[0], t[1], t[0]});
  }
  expect_unseen(p);
}

TEST(Geometry, NeedlesCannotBeSeen) {
  // A millionth as wide as they are long, on the sphere and through it.
  Picture p = white_sphere("with needles");
  std::mt19937 random(2);
  std::uniform_real_distribution<float> u(-1.2f, 1.2f);
  Mesh needles;
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Vec3 a{u(random), u(random), u(random)}, b{u(random), u(random), u(random)};
    needles.positions.insert(needles.positions.end(),
                             {a, b, a + (b - a) * 0.5f + Vec3{0, 0, 1e-6f}});
    needles.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  pictures::add_object(p.scene, needles, 0);
  expect_unseen(p);
}

TEST(Geometry, DuplicateFacesCannotBeSeen) {
  Picture p = white_sphere("twice, once inside out");
  pictures::add_object(p.scene, p.scene.objects[0].mesh, 0);
  pictures::add_object(p.scene, pictures::inside_out(p.scene.objects[0].mesh), 0);
  expect_unseen(p);
}

TEST(Geometry, FlippedWindingChangesNothingOfAMatteBody) {
  Picture p = white_sphere("grey, some faces flipped");
  pictures::set_input(p.scene, 0, "kd", {0.5f, 0.5f, 0.5f});
  const Film usual = hard::trace(p, {});
  Mesh& mesh = p.scene.objects[0].mesh;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 2)
    std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  hard::everywhere(
      p, [&](const Film& film) { EXPECT_NEAR(hard::mean_of(film), hard::mean_of(usual), 1e-3); });
}

TEST(Geometry, NormalsThatOpposeTheirFacesLoseNoLightAndMakeNone) {
  for (const std::string& material : hard::materials(true)) {
    Picture p = white_sphere(material + ", normals at random", true);
    p.engine.spp = 64;
    p.scene.materials.clear();
    p.scene.objects[0].material = hard::add_material(p.scene, material);
    for (std::size_t m = 0; m < p.scene.materials.size(); ++m)
      for (const char* input : {"kd", "ks", "kr", "kt"})
        if (find_input(material_types()[static_cast<std::size_t>(p.scene.materials[m].type)],
                       input) >= 0)
          pictures::set_input(p.scene, static_cast<int>(m), input, {1, 1, 1});
    const double usual = hard::mean_of(hard::trace(p, {}));
    std::mt19937 random(4);
    std::uniform_real_distribution<float> u(-1, 1);
    Mesh& mesh = p.scene.objects[0].mesh;
    for (std::size_t i = 0; i < mesh.normals.size(); ++i)
      mesh.normals[i] = i % 3 == 0   ? -mesh.normals[i]
                        : i % 3 == 1 ? normalized(Vec3{u(random), u(random), u(random)})
                                     : Vec3{};
    hard::everywhere(p, [&](const Film& film) {
      // What reflects all light from every angle does so about any normal; a metal's reflectance
      // is another at another angle, and a coat is rough.
      const bool all = material == "matte" || material == "mirror" || material == "glass";
      EXPECT_NEAR(hard::mean_of(film), usual, (all ? 1e-3 : 0.06) * usual);
      if (all) {
        EXPECT_NEAR(usual, 1, 1e-3);
      }
    });
  }
}

TEST(Geometry, OfCoplanarFacesTheFirstIsSeenEverywhere) {
  // Two squares in one plane, and a box that stands in the ground's plane, as models do at z =
  // -0.0574.
  Picture p = hard::deep_picture(16, 8);
  p.name = "coplanar";
  const int first = pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f});
  const int second = pictures::add_matte(p.scene, {0.9f, 0.9f, 0.9f});
  pictures::add_object(p.scene, pictures::quad({0, 0, -0.0574f}, {1, 0.3f, 0}, {-0.3f, 1, 0}),
                       first);
  pictures::add_object(p.scene, pictures::quad({0, 0, -0.0574f}, {1, 0.3f, 0}, {-0.3f, 1, 0}),
                       second);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  p.camera.position = {0.2, -0.3, 1};
  p.camera.fov_deg = 30;
  hard::everywhere(p, [](const Film& film) { EXPECT_LT(hard::worst_difference(film, 0.5), 1e-6); });
}

TEST(Geometry, ABoxOnTheGroundLetsNoLightUnderIt) {
  // The bottom lies in the ground's plane, z = -0.0574; sides down to it. Seen from inside.
  Picture p = hard::deep_picture(12, 32);
  p.name = "box on the ground";
  const int grey = pictures::add_matte(p.scene, {0.8f, 0.8f, 0.8f});
  pictures::add_object(p.scene, pictures::quad({0, 0, -0.0574f}, {5, 0, 0}, {0, 5, 0}), grey);
  Mesh box = pictures::box({0, 0, 0.0f}, {0.08f, 0.05f, 0.0574f});
  pictures::add_object(p.scene, box, grey);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  p.camera.position = {0.03, 0.01, -0.02};
  p.camera.target = {-0.05, -0.02, -0.0574};
  p.camera.fov_deg = 90;
  p.engine.depth_total = 16;
  hard::everywhere(p, [](const Film& film) { EXPECT_EQ(hard::mean_of(film), 0.0); });
}

TEST(Geometry, AWallStandsOnAGroundOfAnySize) {
  // The lowest half millimetre of a wall of 0.5 on a black ground under a sky of 1 sees half of the
  // sky. A ray down to the ground may start nearer to it than floats tell depths of its corners.
  for (const float half : {5.0f, 500.0f, 5000.0f})
    for (const double turn : {0.0, 0.3}) {
      Picture p = hard::deep_picture(8, 256);
      p.name = "ground of " + std::to_string(half) + " m turned by " + std::to_string(turn);
      p.engine.depth_total = 1;
      const auto c = half * static_cast<float>(std::cos(turn));
      const auto s = half * static_cast<float>(std::sin(turn));
      const float ground = -0.0574f;
      pictures::add_object(p.scene, pictures::quad({0.01f, 0.02f, ground}, {c, s, 0}, {-s, c, 0}),
                           pictures::add_matte(p.scene, {0, 0, 0}));
      pictures::add_object(p.scene, pictures::box({0, 0, ground + 0.08f}, {0.08f, 0.05f, 0.08f}),
                           pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f}));
      p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
      p.camera.position = {0, -0.15, double{ground} + 0.00025};
      p.camera.target = {0, -0.05, double{ground} + 0.00025};
      p.camera.fov_deg = 2 * std::atan(0.00025 / 0.1) * 180 / M_PI;
      hard::everywhere(p, [](const Film& film) {
        // 16,384 samples of 0 or 0.5: 4 sigma is 0.008.
        EXPECT_NEAR(hard::mean_of(film), 0.25, 0.01);
      });
    }
}

TEST(Geometry, CameraInsideABody) {
  // At the centre of a glass sphere every way out is square to it: radiance is n^2 of the sky's.
  Picture glass = hard::deep_picture(8, 64);
  glass.name = "camera in glass";
  pictures::add_object(glass.scene, pictures::sphere({}, 1, 48, false),
                       pictures::add_material(glass.scene, "glass"));
  glass.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  glass.camera.position = {};
  glass.camera.target = {0.3, 1, 0.2};
  glass.camera.fov_deg = 60;
  hard::everywhere(
      glass, [](const Film& film) { EXPECT_LT(hard::worst_difference(film, 1.5 * 1.5), 1e-4); });
  // Inside a closed white one there is nothing.
  for (const std::string& material : hard::materials(false)) {
    Picture p = hard::deep_picture(8, 8);
    p.engine.depth_total = 16;
    p.name = "camera in " + material;
    pictures::add_object(p.scene, pictures::sphere({}, 1, 12, true),
                         hard::add_material(p.scene, material));
    p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
    p.camera.position = {0.1, 0.2, 0.3};
    hard::everywhere(p, [](const Film& film) { EXPECT_EQ(hard::mean_of(film), 0.0); });
  }
}

TEST(Geometry, AMillionTriangles) {
  Picture p = hard::deep_picture(8, 8);
  p.name = "a million triangles";
  pictures::add_object(p.scene, pictures::sphere({}, 1, 500, false),
                       pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f}));
  ASSERT_GT(p.scene.objects[0].mesh.triangles.size(), 990000u);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  p.camera.position = {0.6, -1.7, 0.8};
  p.camera.fov_deg = 20;
  // Two ways: building the tree eight times would take a minute.
  for (const hard::Way& way : {hard::Way{}, hard::Way{MathMode::fast, 1, true}}) {
    const Film film = hard::trace(p, way);
    EXPECT_LT(hard::worst_difference(film, 0.5), 1e-6) << way.name();
  }
}

TEST(Geometry, TenThousandMaterials) {
  // A square of a hundred by a hundred tiles, each of its own grey, and a pixel a tile.
  constexpr int k_side = 100;
  Picture p = hard::deep_picture(k_side, 4);
  p.name = "ten thousand materials";
  p.engine.depth_total = 1;
  const auto grey = [](int i) { return static_cast<float>(i % 9973 + 1) / 10000; };
  for (int i = 0; i < k_side * k_side; ++i) {
    const int m = pictures::add_matte(p.scene, {grey(i), 0.5f * grey(i), 1 - grey(i)});
    const Vec3 centre{static_cast<float>(i % k_side) - 49.5f,
                      49.5f - static_cast<float>(i / k_side), 0};
    pictures::add_object(p.scene, pictures::quad(centre, {0.5f, 0, 0}, {0, 0.5f, 0}), m);
  }
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  p.camera.position = {0, 0, 50};
  p.camera.up = {0, 1, 0};
  p.camera.fov_deg = 90;
  hard::everywhere(p, [&](const Film& film) {
    int wrong = 0;
    for (int i = 0; i < k_side * k_side; ++i)
      wrong += std::fabs(film.rgb[static_cast<std::size_t>(3 * i)] - grey(i)) > 2e-6f;
    // A sample on the very border of its pixel may fall on the neighbour's tile.
    EXPECT_LE(wrong, 20);
  });
}

}  // namespace
}  // namespace ds
