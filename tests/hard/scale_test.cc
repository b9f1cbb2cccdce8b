// SPDX-License-Identifier: Apache-2.0
// Scenes of a micrometre and of a thousand kilometres, and far from the origin: the same picture.
#include "tests/hard/everywhere.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace ds {
namespace {

using pictures::Picture;

const std::vector<hard::Way> k_two_ways = {{}, {MathMode::fast, 1, true}};

/// Whether the light has any: it is a lamp then, whose light thins with distance.
template <typename Move>
bool move_points(Light& light, const Move& move) {
  bool any = false;
  for (const LightInput& input : type_of(light).host.inputs) {
    if (input.value != LightValue::point) continue;
    set_light_value(light, input.name, move(light_vector(light, input.name)));
    any = true;
  }
  return any;
}

/// The picture with every length times `s`: lamps shine s^2 as strongly, so that every radiance is
/// what it was.
Picture scaled(Picture p, float s) {
  for (Object& object : p.scene.objects)
    for (Vec3& v : object.mesh.positions)
      v = v * s;
  for (Light& light : p.scene.lights)
    if (move_points(light, [&](Vec3 point) { return point * s; }))
      light.color = light.color * (s * s);
  for (Texture& texture : p.scene.textures)
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 3; ++column)
        texture.world_to_texture.m[row * 4 + column] /= double{s};
  p.camera.position = p.camera.position * double{s};
  p.camera.target = p.camera.target * double{s};
  p.camera.lens_radius_m *= double{s};
  p.camera.focus_distance_m *= double{s};
  return p;
}

Picture moved(Picture p, Vec3 by) {
  for (Object& object : p.scene.objects)
    for (Vec3& v : object.mesh.positions)
      v = v + by;
  for (Light& light : p.scene.lights)
    move_points(light, [&](Vec3 point) { return point + by; });
  p.camera.position = p.camera.position + to_double(by);
  p.camera.target = p.camera.target + to_double(by);
  return p;
}

TEST(Scale, APowerOfTwoChangesNoBit) {
  // Every operation of the tracer is exact under it; a constant in metres would show.
  // Another strict way has the bits of this one (the tests of the same bits).
  for (const Picture& picture : pictures::all_effects())
    for (const hard::Way& way : k_two_ways) {
      const std::string usual = pictures::film_hash(hard::trace(picture, way));
      for (const float s : {0x1p-20f, 0x1p-10f, 0x1p10f, 0x1p20f})
        EXPECT_EQ(pictures::film_hash(hard::trace(scaled(picture, s), way)), usual)
            << picture.name << " times " << s << ", " << way.name();
    }
}

/// Scales and places a unit scene may have.
struct Place {
  float scale;
  Vec3 centre;
};
const std::vector<Place> k_places = {
    {1e-6f, {}},
    {1e-3f, {}},
    {1, {}},
    {1e3f, {}},
    {1e6f, {}},
    {1, {1e5f, -1e5f, 1e5f}},
    // Embree's verify.cpp, WatertightTest
    {10, {148376, 1234, -223423}},
    {1e-3f, {100, 100, -100}},
};

TEST(Scale, NoRayMeetsAgainTheSurfaceItLeaves) {
  // Convex and under a sky of 1: one reflection, then the sky. Met again, 0.5 becomes 0.25.
  for (const Place& place : k_places) {
    Picture p = hard::deep_picture(12, 64);
    p.name = "sphere times " + std::to_string(place.scale);
    const int grey = pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f});
    pictures::add_object(p.scene, pictures::sphere({}, 1, 12, false), grey);
    p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
    p.camera.position = {0.6, -1.7, 0.8};
    p.camera.fov_deg = 20;
    p = moved(scaled(p, place.scale), place.centre);
    hard::everywhere(p,
                     [](const Film& film) { EXPECT_LT(hard::worst_difference(film, 0.5), 1e-6); });
  }
}

TEST(Scale, NoRayOfAnyMaterialMeetsAgainTheSurfaceItLeaves) {
  // A convex body of every material that lets no light through: whoever may visit sixteen surfaces
  // visits one, to the last bit.
  for (const Place& place : k_places) {
    Picture p = hard::deep_picture(12, 64);
    std::vector<int> all;
    for (const std::string& material : hard::materials(false))
      all.push_back(hard::add_material(p.scene, material));
    hard::add_patches(p.scene, pictures::sphere({}, 1, 6, false), all);
    p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
    p.camera.position = {0.6, -1.7, 0.8};
    p.camera.fov_deg = 20;
    p = moved(scaled(p, place.scale), place.centre);
    for (const hard::Way& way : hard::ways()) {
      p.engine.depth_total = 1;
      const Film once = hard::trace(p, way);
      p.engine.depth_total = 16;
      EXPECT_EQ(hard::trace(p, way).rgb, once.rgb) << "times " << place.scale << ", " << way.name();
      EXPECT_GT(hard::mean_of(once), 0.4);
    }
  }
}

TEST(Scale, NoLightComesIntoAClosedBox) {
  // Of every material that lets none through, seen from inside, under a sky of 1.
  for (const std::string& material : hard::materials(false))
    for (const Place& place : k_places) {
      Picture p = hard::deep_picture(12, 16);
      p.engine.depth_total = 24;
      p.name = material + " box times " + std::to_string(place.scale);
      const int wall = hard::add_material(p.scene, material);
      pictures::add_object(p.scene, pictures::box({0, 0, 0}, {1, 0.8f, 0.6f}), wall);
      pictures::add_object(p.scene, pictures::sphere({-0.3f, 0.2f, 0}, 0.3f, 8, true), wall);
      p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
      p.camera.position = {0.7, -0.6, 0.4};
      p.camera.fov_deg = 100;
      p = moved(scaled(p, place.scale), place.centre);
      // Far from the origin floats lie so far apart that a point beside an edge may be rounded to
      // the other side of the wall there: a share spacing / 0.6 of the wall at each of 24 bounces.
      const float farthest = std::max(
          {std::fabs(place.centre.x), std::fabs(place.centre.y), std::fabs(place.centre.z)});
      const double spacing = double{std::nextafter(farthest, 1e30f) - farthest};
      const double limit = 24 * spacing / (0.6 * double{place.scale});
      hard::everywhere(p, [&](const Film& film) {
        EXPECT_LE(hard::mean_of(film), farthest == 0 ? 0.0 : limit);
      });
    }
}

TEST(Scale, DecimalScalesAndPlacesChangeNothingButRounding) {
  for (const Picture& original : pictures::all_effects())
    for (const hard::Way& way : k_two_ways) {
      const Film usual = hard::trace(original, way);
      for (const float s : {1e-6f, 1e-3f, 1e3f, 1e6f}) {
        const Film film = hard::trace(scaled(original, s), way);
        EXPECT_EQ(film.rejected_samples, 0u);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < film.rgb.size(); ++i)
          differ += std::fabs(film.rgb[i] - usual.rgb[i]) > 0.01f * (film.rgb[i] + usual.rgb[i]);
        // Rounding moves a hit across an edge or a texture's border here and there.
        EXPECT_LT(differ, film.rgb.size() / 20)
            << original.name << " times " << s << ", " << way.name();
      }
    }
}

TEST(Scale, AHundredTimesItsSizeFromTheOriginChangesLittle) {
  // A scene of a kilometre at 1e5 m, where floats are 8 mm apart: a hundred-thousandth of it.
  const Picture original = pictures::all_effects()[0];
  const Film usual = hard::trace(original, {});
  const Picture far = moved(scaled(original, 1e3f), {1e5f, -1e5f, 1e5f});
  hard::everywhere(far, [&](const Film& film) {
    EXPECT_NEAR(hard::mean_of(film), hard::mean_of(usual), 0.01 * hard::mean_of(usual));
    std::size_t differ = 0;
    for (std::size_t i = 0; i < film.rgb.size(); ++i)
      differ += std::fabs(film.rgb[i] - usual.rgb[i]) > 0.02f * (film.rgb[i] + usual.rgb[i]);
    EXPECT_LT(differ, film.rgb.size() / 20);
  });
}

TEST(Scale, SingleTrianglesOfAnySizeAndPlaceReflectOnce) {
  // As pbrt's Triangle.Reintersect: coordinates of 1e-8 .. 1e8, all three axes of their own size.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-8, 8), u(-1, 1);
  int seen = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Picture p = hard::deep_picture(4, 16);
    p.name = "triangle " + std::to_string(trial);
    const int matte = pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f});
    const int mirror = pictures::add_material(p.scene, "mirror");
    pictures::set_input(p.scene, mirror, "kr", {0.5f, 0.5f, 0.5f});
    const int material = std::array{
        matte, mirror, hard::add_mix(p.scene, matte, mirror)}[static_cast<std::size_t>(trial % 3)];
    const double size = std::pow(10, exponent(random));
    Mesh mesh;
    for (int i = 0; i < 3; ++i)
      mesh.positions.push_back(to_float(Vec3d{u(random), u(random), u(random)} * size));
    mesh.triangles = {{0, 1, 2}};
    const Vec3d a = to_double(mesh.positions[0]), b = to_double(mesh.positions[1]),
                c = to_double(mesh.positions[2]);
    const Vec3d normal = cross(b - a, c - a);
    const double area = length(normal);
    if (area < 1e-3 * size * size) continue;
    const Vec3d middle = (a + b + c) * (1.0 / 3);
    pictures::add_object(p.scene, mesh, material);
    p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
    p.camera.target = middle;
    p.camera.position = middle + normal * (size / area) + (b - a) * 0.7;
    p.camera.fov_deg = 0.1;
    p.name += " of size " + std::to_string(size);
    hard::everywhere(p,
                     [](const Film& film) { EXPECT_LT(hard::worst_difference(film, 0.5), 1e-6); });
    ++seen;
  }
  EXPECT_GT(seen, 40);
}

}  // namespace
}  // namespace ds
