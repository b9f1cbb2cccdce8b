// SPDX-License-Identifier: Apache-2.0
// Whole pictures against closed forms: furnaces, and the light of each kind of lamp on a matte
// plane.
#include "tests/render/pictures.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace ds {
namespace {

using pictures::Estimate;
using pictures::Picture;

constexpr double k_pi = std::numbers::pi;

/// From straight above: pixel (column, row) of a box filter sees the plane z = 0 at world_of(...).
struct FromAbove {
  double height = 2;
  double fov_deg = 40;
  int pixels = 12;

  Camera camera() const {
    Camera c;
    c.position = {0, 0, static_cast<float>(height)};
    c.up = {0, 1, 0};
    c.fov_deg = fov_deg;
    return c;
  }
  /// x, y in pixels, row 0 at the top.
  Vec3d world_of(double x, double y) const {
    const double half = std::tan(fov_deg * k_pi / 360) * height;
    return {(2 * x / pixels - 1) * half, (1 - 2 * y / pixels) * half, 0};
  }
};

Picture above_plane(const FromAbove& view, Vec3 kd) {
  Picture p;
  const int plane = pictures::add_matte(p.scene, kd);
  pictures::add_object(p.scene, pictures::quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0}), plane);
  p.camera = view.camera();
  p.engine.width = p.engine.height = view.pixels;
  p.engine.filter_width = 0;
  p.engine.spp = 16;
  return p;
}

/// Radiance of every pixel against `irradiance` on a matte plane of reflectance 0.5, averaged over
/// the pixel.
void expect_direct_light(const Picture& picture, const FromAbove& view, int pictures_traced,
                         const std::function<double(Vec3d)>& irradiance,
                         double model_error = 1e-5) {
  const std::vector<Estimate> seen = pictures::estimate_pixels(picture, pictures_traced);
  constexpr int k_sub = 8;
  for (int row = 0; row < view.pixels; ++row)
    for (int column = 0; column < view.pixels; ++column) {
      double expected = 0;
      for (int i = 0; i < k_sub * k_sub; ++i)
        expected += irradiance(view.world_of(column + (i % k_sub + 0.5) / k_sub,
                                             row + (i / k_sub + 0.5) / k_sub)) *
                    0.5 / k_pi / (k_sub * k_sub);
      const Estimate& e = seen[static_cast<std::size_t>(row * view.pixels + column)];
      // 144 pixels: 5 standard errors of 48 pictures are passed by one in about 1000.
      EXPECT_NEAR(e.mean, expected, 5 * e.error + model_error * (1 + expected))
          << "pixel " << column << ", " << row;
    }
}

TEST(DirectLight, PointLampOnAPlane) {
  const FromAbove view;
  Picture p = above_plane(view, {0.5f, 0.5f, 0.5f});
  p.scene.lights.push_back(pictures::point_light({0.2f, -0.1f, 0.7f}, {3, 3, 3}));
  expect_direct_light(
      p, view, 48,
      [](Vec3d at) {
        const Vec3d way = Vec3d{double{0.2f}, double{-0.1f}, double{0.7f}} - at;
        return 3 * way.z / std::pow(length(way), 3);
      },
      2e-4);
}

/// Lamps of different power all around, some below the plane, whose light must not count; one
/// stands above a black roof, whose shadow covers the plane.
TEST(DirectLight, AnyNumberOfLampsOnAPlane) {
  for (const int count : {2, 7, 8, 9, 20}) {  // k_most_rounds is 8
    SCOPED_TRACE(count);
    const FromAbove view;
    Picture p = above_plane(view, {0.5f, 0.5f, 0.5f});
    p.engine.spp = 64;
    pictures::add_object(p.scene, pictures::quad({0, 0, 2.5f}, {8, 0, 0}, {0, 8, 0}),
                         pictures::add_matte(p.scene, {0, 0, 0}));
    for (int i = 0; i < count; ++i) {
      const double turn = 2 * k_pi * i / count;
      const float z = i == 0 ? 2.75f : i == 1 ? -0.5f : 0.4f + 0.2f * static_cast<float>(i % 3);
      const float power = i == 0 ? 100.0f : static_cast<float>(1 + i % 4) / 2;
      p.scene.lights.push_back(pictures::point_light(
          {static_cast<float>(0.6 * std::cos(turn)), static_cast<float>(0.6 * std::sin(turn)), z},
          {power, power, power}));
    }
    expect_direct_light(
        p, view, 48,
        [&](Vec3d at) {
          double sum = 0;
          for (int i = 2; i < count; ++i) {
            const Light& lamp = p.scene.lights[static_cast<std::size_t>(i)];
            const Vec3d way = to_double(light_vector(lamp, "position")) - at;
            sum += double{lamp.color.x} * way.z / std::pow(length(way), 3);
          }
          return sum;
        },
        3e-3);
  }
}

TEST(DirectLight, SpotLampOnAPlane) {
  const FromAbove view;
  Picture p = above_plane(view, {0.5f, 0.5f, 0.5f});
  const Light lamp = pictures::spot_light({0.3f, 0, 1.2f}, {-0.25f, 0, -1}, 25, 12, {3, 3, 3});
  p.scene.lights.push_back(lamp);
  expect_direct_light(
      p, view, 48,
      [&](Vec3d at) {
        const Vec3d way = to_double(light_vector(lamp, "position")) - at;
        const double cosine = dot(way, -to_double(light_vector(lamp, "direction"))) / length(way);
        const float total = *light_value(lamp, "cos_total");
        const float width = *light_value(lamp, "cos_falloff") - total;
        const double ramp = std::clamp((cosine - double{total}) / double{width}, 0.0, 1.0);
        // scene.h: falloff(cos a) / cos a.
        return 3 * std::pow(ramp, 4) / cosine * way.z / std::pow(length(way), 3);
      },
      3e-3);
}

TEST(DirectLight, SunOnAPlane) {
  const FromAbove view;
  for (const double radius_deg : {0.265, 5.0}) {
    Picture p = above_plane(view, {0.5f, 0.5f, 0.5f});
    const Light sun = pictures::sun_light({0.4f, 0.3f, 0.5f}, radius_deg, {200, 200, 200});
    p.scene.lights.push_back(sun);
    // The disc is wholly above the horizon, so the mean of the cosine over it is sin^2 / 2 over 1 -
    // cos, times the centre's.
    const double radius = radius_deg * k_pi / 180;
    const double expected =
        200 * k_pi * std::pow(std::sin(radius), 2) * double{light_vector(sun, "direction").z};
    // The cosine of the sun's radius is stored as a float, good to 3e-8: 3e-3 of 1 - cos for the
    // real sun.
    expect_direct_light(
        p, view, 48, [&](Vec3d) { return expected; }, 3e-3);
  }
}

TEST(DirectLight, SharpdistantOnAPlane) {
  const FromAbove view;
  Picture p = above_plane(view, {0.5f, 0.5f, 0.5f});
  Light light = make_light("sharpdistant");
  light.color = {3, 3, 3};
  const Vec3d way = normalized(Vec3d{0.4, 0.3, -0.5});
  set_light_value(light, "direction", to_float(way));
  p.scene.lights.push_back(light);
  expect_direct_light(p, view, 8, [&](Vec3d) { return 3 * -way.z; });
}

TEST(DirectLight, DistantOnAPlane) {
  const FromAbove view;
  for (const double theta_deg : {0.5, 10.0, 40.0}) {
    Picture p = above_plane(view, {0.5f, 0.5f, 0.5f});
    Light light = make_light("distant");
    light.color = {3, 3, 3};
    const Vec3d way = normalized(Vec3d{0.4, 0.3, -0.8});
    set_light_value(light, "direction", to_float(way));
    *light_value(light, "theta") = static_cast<float>(theta_deg);
    p.scene.lights.push_back(light);
    // The cone is wholly above the plane: as the sun's.
    const double sine = std::sin(theta_deg * k_pi / 180);
    expect_direct_light(
        p, view, 48, [&](Vec3d) { return 3 * k_pi * sine * sine * -way.z; }, 1e-4);
  }
}

TEST(Cameras, ParallelRaysShowTheSameSizeAtAnyDistance) {
  for (std::size_t type = 0; type < camera_types().size(); ++type) {
    if (camera_types()[type].host.span != kernels::CameraSpan::extent_m) continue;
    for (const float z : {0.5f, -3.0f, -4000.0f}) {
      Picture p = above_plane({}, {0.5f, 0.5f, 0.5f});
      p.scene.objects.clear();
      p.scene.materials[0].emits = true;
      p.scene.materials[0].emission.constant = {2, 2, 2};
      // Pixels are 0.125 wide: 2 .. 5 of 8 across, 1 .. 2 of 4 down.
      pictures::add_object(p.scene, pictures::quad({0, 0, z}, {0.25f, 0, 0}, {0, 0.125f, 0}), 0);
      p.camera.type = static_cast<int>(type);
      p.camera.extent_m = 1;
      p.engine.width = 8;
      p.engine.height = 4;
      const Film film = pictures::trace(p);
      for (int i = 0; i < 32; ++i) {
        const int x = i % 8, y = i / 8;
        const bool inside = x >= 2 && x < 6 && y >= 1 && y < 3;
        EXPECT_EQ(film.rgb[static_cast<std::size_t>(3 * i)], inside ? 2.0f : 0.0f)
            << z << ": " << x << ", " << y;
      }
    }
  }
}

/// Lambert's formula: irradiance at `at`, normal +z, from a polygon above the horizon of
/// radiance 1.
double polygon_irradiance(Vec3d at, const std::vector<Vec3d>& corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3d a = normalized(corners[i] - at);
    const Vec3d b = normalized(corners[(i + 1) % corners.size()] - at);
    sum += std::acos(std::clamp(dot(a, b), -1.0, 1.0)) * normalized(cross(a, b)).z;
  }
  return std::fabs(sum) / 2;
}

TEST(DirectLight, EmittingRectangleOverAPlane) {
  const FromAbove view;
  Picture p = above_plane(view, {0.5f, 0.5f, 0.5f});
  const int lamp = pictures::add_matte(p.scene, {0, 0, 0});
  p.scene.materials.back().emits = true;
  p.scene.materials.back().emission.constant = {2, 2, 2};
  // Behind the camera, facing down, tilted about x.
  pictures::add_object(p.scene, pictures::quad({0.4f, 0, 2.5f}, {0.9f, 0, 0}, {0, -0.5f, 0.2f}),
                       lamp);
  const std::vector<Vec3d> corners = {
      {-0.5, 0.5, 2.3}, {1.3, 0.5, 2.3}, {1.3, -0.5, 2.7}, {-0.5, -0.5, 2.7}};
  expect_direct_light(p, view, 48, [&](Vec3d at) { return 2 * polygon_irradiance(at, corners); });
  // The other side is dark.
  p.scene.objects.back().mesh = pictures::inside_out(p.scene.objects.back().mesh);
  for (const Estimate& e : pictures::estimate_pixels(p, 2))
    EXPECT_EQ(e.mean, 0.0);
}

/// Irradiance from above of a lat-long image looked up bilinearly, by a fine sum.
double image_irradiance(const Image& image) {
  const auto texel = [&](int column, int row) {
    const int x = (column + image.width) % image.width;
    const int y = std::clamp(row, 0, image.height - 1);
    return double{image.rgb[static_cast<std::size_t>((y * image.width + x) * 3)]};
  };
  double sum = 0;
  const int across = image.width * 40;
  const int down = image.height * 40;
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < across; ++i) {
      const double polar = (j + 0.5) / down * k_pi;
      if (polar > k_pi / 2) continue;
      const double x = (i + 0.5) / across * image.width - 0.5;
      const double y = (j + 0.5) / down * image.height - 0.5;
      const double fx = x - std::floor(x);
      const double fy = y - std::floor(y);
      const int c = static_cast<int>(std::floor(x));
      const int r = static_cast<int>(std::floor(y));
      const double radiance = (1 - fy) * ((1 - fx) * texel(c, r) + fx * texel(c + 1, r)) +
                              fy * ((1 - fx) * texel(c, r + 1) + fx * texel(c + 1, r + 1));
      sum += radiance * std::cos(polar) * std::sin(polar);
    }
  return sum * (2 * k_pi / across) * (k_pi / down);
}

TEST(DirectLight, ImageOnAPlane) {
  const FromAbove view{2, 40, 4};
  Picture p = above_plane(view, {0.5f, 0.5f, 0.5f});
  p.engine.spp = 64;
  p.scene.images.push_back(pictures::small_sky());
  p.scene.lights.push_back(pictures::image_light(0));
  const double expected = image_irradiance(p.scene.images[0]);
  // The sum's own error: the horizon cuts through cells.
  expect_direct_light(
      p, view, 48, [&](Vec3d) { return expected; }, 1e-3);
}

/// Everything within `sigmas` standard errors of `expected`.
void expect_mean(const Picture& p, double expected, int pictures_traced, double sigmas = 3) {
  const Estimate e = pictures::estimate(p, pictures_traced);
  EXPECT_NEAR(e.mean, expected, sigmas * e.error + 1e-6) << "standard error " << e.error;
}

Picture deep_picture() {
  Picture p;
  p.engine.width = p.engine.height = 12;
  p.engine.spp = 16;
  p.engine.depth_total = p.engine.depth_diffuse = p.engine.depth_glossy = p.engine.depth_specular =
      1000;
  p.camera.position = {1.5f, -2, 1};
  p.camera.fov_deg = 60;
  return p;
}

TEST(Furnace, WhiteMatteSphereCannotBeSeen) {
  for (const bool smooth : {false, true}) {
    Picture p = deep_picture();
    const int white = pictures::add_matte(p.scene, {1, 1, 1});
    pictures::add_object(p.scene, pictures::sphere({0, 0, 0}, 1, 48, smooth), white);
    p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
    const Film film = pictures::trace(p);
    EXPECT_EQ(film.rejected_samples, 0u);
    if (!smooth) {
      // Every path sees the sky in the end, at weight 1.
      for (const float v : film.rgb)
        ASSERT_NEAR(double{v}, 1.0, 1e-6);
    }
    expect_mean(p, 1.0, 8);
  }
}

TEST(Furnace, WhiteCornerCannotBeSeen) {
  // Concave, so that light goes to and fro.
  Picture p = deep_picture();
  const int white = pictures::add_matte(p.scene, {1, 1, 1});
  pictures::add_object(p.scene, pictures::quad({0, 0, -0.5f}, {1, 0, 0}, {0, 1, 0}), white);
  pictures::add_object(p.scene, pictures::quad({0, 0.5f, 0}, {1, 0, 0}, {0, 0, 1}), white);
  pictures::add_object(p.scene, pictures::box({0.1f, 0, -0.2f}, {0.2f, 0.2f, 0.3f}), white);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  for (const float v : pictures::trace(p).rgb)
    ASSERT_NEAR(double{v}, 1.0, 2e-6);
}

TEST(Furnace, ImageOfOnesIsSampledAsTheConstantIs) {
  Picture p = deep_picture();
  p.engine.spp = 64;
  const int grey = pictures::add_matte(p.scene, {0.7f, 0.7f, 0.7f});
  pictures::add_object(p.scene, pictures::sphere({0, 0, 0}, 1, 24, false), grey);
  pictures::add_object(p.scene, pictures::quad({0, 0, -1.05f}, {2, 0, 0}, {0, 2, 0}), grey);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  const Estimate constant = pictures::estimate(p, 16);
  Image ones;
  ones.width = 8;
  ones.height = 4;
  ones.rgb.assign(8 * 4 * 3, 1.0f);
  p.scene.images.push_back(ones);
  p.scene.lights[0] = pictures::image_light(0);
  const Estimate image = pictures::estimate(p, 16, 100);
  EXPECT_NEAR(image.mean, constant.mean, 3 * std::hypot(image.error, constant.error));
}

Picture glowing_box(double kd, double emission) {
  Picture p = deep_picture();
  const auto grey = static_cast<float>(kd);
  const int wall = pictures::add_matte(p.scene, {grey, grey, grey});
  const auto glow = static_cast<float>(emission);
  p.scene.materials.back().emits = true;
  p.scene.materials.back().emission.constant = {glow, glow, glow};
  pictures::add_object(p.scene, pictures::inside_out(pictures::box({0, 0, 0}, {1, 0.8f, 0.6f})),
                       wall);
  p.camera.position = {0.3f, -0.4f, 0.2f};
  return p;
}

TEST(Furnace, GlowingBoxFillsWithLight) {
  // L = Le + kd L everywhere inside.
  expect_mean(glowing_box(0.5, 0.5), 1.0, 16);
  expect_mean(glowing_box(0.8, 0.2), 1.0, 16);
}

TEST(Furnace, PathsOfDepthNCarryNBounces) {
  Picture p = glowing_box(0.5, 0.5);
  double expected = 0.5;
  for (int depth = 1; depth <= 4; ++depth) {
    expected += 0.5 * std::pow(0.5, depth);
    p.engine.depth_total = depth;
    expect_mean(p, expected, 16);
  }
}

TEST(Furnace, GlassCannotBeSeen) {
  // Radiance divided by the square of the index is kept at each boundary; inside out it comes back
  // to 1.
  Picture p = deep_picture();
  const int glass = pictures::add_material(p.scene, "glass");
  pictures::add_object(p.scene, pictures::sphere({0, 0, 0}, 1, 16, false), glass);
  pictures::add_object(p.scene, pictures::box({1.2f, -1.2f, 0.3f}, {0.1f, 0.2f, 0.3f}), glass);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  expect_mean(p, 1.0, 16);
}

TEST(Furnace, MirrorCannotBeSeen) {
  Picture p = deep_picture();
  const int mirror = pictures::add_material(p.scene, "mirror");
  pictures::add_object(p.scene, pictures::sphere({0, 0, 0}, 1, 16, false), mirror);
  pictures::add_object(p.scene, pictures::quad({0, 0, -1.2f}, {2, 0, 0}, {0, 2, 0}), mirror);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  for (const float v : pictures::trace(p).rgb)
    ASSERT_NEAR(double{v}, 1.0, 2e-6);
}

}  // namespace
}  // namespace ds
