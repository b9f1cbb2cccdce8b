// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/camera_fit.h"

#include "tracer/base/error.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ds {
namespace {

/// The farthest of a sphere's points from the picture's middle, 1 at its edge, seen by a pinhole;
/// of points spread over the whole sphere. Infinite where one is behind the camera.
double extent(const Camera& camera, const Sphere& sphere, int width, int height) {
  const Vec3d sight = normalized(camera.target - camera.position);
  const Vec3d right = normalized(cross(sight, camera.up)), up = cross(right, sight);
  const double half = std::tan(camera.fov_deg * std::numbers::pi / 360);
  const double longer = std::max(width, height);
  constexpr int k_points = 200'000;
  double most = 0;
  for (int i = 0; i < k_points; ++i) {
    const double z = 1 - (2 * i + 1.0) / k_points, around = i * 2.399963229728653;
    const double ring = std::sqrt(1 - z * z);
    const Vec3d point =
        sphere.centre +
        Vec3d{ring * std::cos(around), ring * std::sin(around), z} * sphere.radius_m -
        camera.position;
    const double depth = dot(point, sight);
    if (depth <= 0) return std::numeric_limits<double>::infinity();
    most = std::max({most, std::abs(dot(point, right)) / depth / half * longer / width,
                     std::abs(dot(point, up)) / depth / half * longer / height});
  }
  return most;
}

Camera camera_at(Vec3d direction, Vec3d target) {
  Camera camera;
  camera.target = target;
  camera.position = target + normalized(direction);
  camera.up = {0, 0, 1};
  return camera;
}

TEST(CameraFitTest, the_sphere_just_touches_the_margin) {
  const Vec3d directions[] = {{1, 0, 0}, {-0.3, 0.8, 0.2}, {1, 1, 1}, {0.1, -0.2, 5}};
  const Sphere spheres[] = {
      {{0, 0, 0}, 0.08}, {{0.01, -0.03, -0.04}, 0.09}, {{0.5, 0.2, 0.3}, 0.01}, {{0, 0, 9}, 3}};
  const int sizes[][2] = {{256, 256}, {320, 100}, {100, 320}};
  for (const Vec3d direction : directions)
    for (const Sphere& sphere : spheres)
      for (const auto& [width, height] : sizes)
        for (const double fov_deg : {10.0, 49.0, 120.0})
          for (const double margin : {0.0, 0.05, 0.5}) {
            Camera camera = camera_at(direction, {0.02, 0.01, 0});
            camera.fov_deg = fov_deg;
            CameraFit fit{margin, CameraFit::Focus::distance};
            const Camera fitted = fit_camera(camera, fit, sphere, width, height);
            EXPECT_NEAR(extent(fitted, sphere, width, height), 1 - margin, 2e-3 * (1 - margin));
            // It only moved along its line of sight.
            const Vec3d sight = normalized(fitted.target - fitted.position);
            EXPECT_NEAR(length(sight + normalized(direction)), 0, 1e-9);
          }
}

TEST(CameraFitTest, parallel_rays_show_the_sphere_and_its_margin) {
  for (std::size_t type = 0; type < camera_types().size(); ++type) {
    if (camera_types()[type].host.span != kernels::CameraSpan::extent_m) continue;
    Camera camera = camera_at({0, -1, 0}, {0.02, 0, 0});
    camera.type = static_cast<int>(type);
    // Of a picture twice as wide as it is high, x is 0.02 from the middle and 0.1 away, z 0.1.
    const Camera fitted = fit_camera(camera, {0.5, CameraFit::Focus::target}, {{}, 0.1}, 64, 32);
    EXPECT_NEAR(fitted.extent_m, 2 * 0.1 * 2 / 0.5, 1e-12);
    const Camera tall = fit_camera(camera, {0, CameraFit::Focus::target}, {{}, 0.1}, 32, 64);
    EXPECT_NEAR(tall.extent_m, 2 * 0.12 * 2, 1e-12);
    // It stands a diameter before the sphere's middle.
    EXPECT_NEAR(fitted.position.y, -0.2, 1e-12);
    EXPECT_NEAR(fitted.position.x, 0.02, 1e-12);
    EXPECT_NEAR(fitted.focus_distance_m, 0.2, 1e-12);
  }
}

TEST(CameraFitTest, a_sphere_at_the_target_has_a_closed_form) {
  Camera camera = camera_at({0, -1, 0}, {});
  camera.fov_deg = 60;
  const Camera fitted = fit_camera(camera, {0, CameraFit::Focus::origin}, {{}, 0.1}, 64, 64);
  EXPECT_NEAR(length(fitted.position), 0.2, 1e-12);  // 0.1 / sin(30 degrees)
  EXPECT_NEAR(fitted.focus_distance_m, 0.2, 1e-12);
}

TEST(CameraFitTest, focus_follows_the_camera) {
  Camera camera = camera_at({1, 0, 0}, {0.5, 0, 0});
  camera.fov_deg = 60;
  camera.focus_distance_m = 7;
  const Sphere sphere{{0.5, 0, 0}, 0.1};
  using enum CameraFit::Focus;
  EXPECT_NEAR(fit_camera(camera, {0, origin}, sphere, 64, 64).focus_distance_m, 0.7, 1e-12);
  EXPECT_NEAR(fit_camera(camera, {0, target}, sphere, 64, 64).focus_distance_m, 0.2, 1e-12);
  EXPECT_EQ(fit_camera(camera, {0, distance}, sphere, 64, 64).focus_distance_m, 7);
  camera = camera_at({-1, 0, 0}, {0.5, 0, 0});  // between the origin and the target
  camera.fov_deg = 60;
  EXPECT_NEAR(fit_camera(camera, {0, origin}, sphere, 64, 64).focus_distance_m, 0.2, 1e-12)
      << "a pinhole is sharp everywhere";
  camera.lens_radius_m = 0.01;
  EXPECT_THROW(fit_camera(camera, {0, origin}, sphere, 64, 64), Error);
}

TEST(CameraFitTest, the_bounding_sphere_of_a_box_goes_through_its_corners) {
  Mesh mesh;
  for (const float x : {-1.0f, 3.0f})
    for (const float y : {0.0f, 2.0f})
      for (const float z : {5.0f, 9.0f})
        mesh.positions.push_back({x, y, z});
  mesh.positions.push_back({100, 100, 100});  // of no triangle
  mesh.triangles = {{0, 1, 2}, {5, 6, 7}, {3, 4, 0}};
  const Sphere sphere = bounding_sphere(mesh);
  EXPECT_EQ(sphere.centre, (Vec3d{1, 1, 7}));
  EXPECT_DOUBLE_EQ(sphere.radius_m, 3);  // sqrt(4 + 1 + 4)
  EXPECT_EQ(bounding_sphere({}), Sphere{});
}

}  // namespace
}  // namespace ds
