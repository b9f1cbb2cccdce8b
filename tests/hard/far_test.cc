// SPDX-License-Identifier: Apache-2.0
// Cameras far from what they see: pictures, masks and depths against rays cast in double.
#include "tests/hard/everywhere.h"
#include "tracer/render/view.h"
#include "tracer/scene/sdl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace ds {
namespace {

using pictures::Picture;

/// The farthest a recipe's coordinates allow, by axis.
constexpr double k_farthest_m = 1e6;

/// Moeller and Trumbore in double: planar depth through the middle of each pixel of the nearest of
/// the objects with this id, 0 where another is nearer or none is met.
std::vector<double> cast(const Scene& scene, const Camera& camera, int size) {
  const Vec3d forward = normalized(camera.target - camera.position);
  const Vec3d right = normalized(cross(forward, camera.up));
  const Vec3d up = cross(right, forward);
  const double half = std::tan(camera.fov_deg * std::numbers::pi / 360);
  std::vector<double> depths;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const Vec3d ray = forward + right * (half * ((x + 0.5) / size * 2 - 1)) +
                        up * (half * (1 - (y + 0.5) / size * 2));
      double nearest = 1e300;
      bool model = false;
      for (const Object& object : scene.objects)
        for (const auto& t : object.mesh.triangles) {
          const Vec3d a = to_double(object.mesh.positions[t[0]]) - camera.position;
          const Vec3d e1 = to_double(object.mesh.positions[t[1]]) - camera.position - a;
          const Vec3d e2 = to_double(object.mesh.positions[t[2]]) - camera.position - a;
          const Vec3d p = cross(ray, e2), q = cross(-a, e1);
          const double det = dot(p, e1);
          const double u = dot(p, -a) / det, v = dot(ray, q) / det, depth = dot(e2, q) / det;
          if (!(u >= 0 && v >= 0 && u + v <= 1 && depth > 0 && depth < nearest)) continue;
          nearest = depth;
          model = object.id == k_model_object_id;
        }
      depths.push_back(model ? nearest : 0);
    }
  return depths;
}

/// Whether a pixel's neighbours are all on the same side of the outline.
bool is_inner(const std::vector<double>& depths, int size, int x, int y) {
  const bool hit = depths[static_cast<std::size_t>(y * size + x)] > 0;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, size - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, size - 1); ++i)
      if ((depths[static_cast<std::size_t>(j * size + i)] > 0) != hit) return false;
  return true;
}

/// A body without symmetry about the origin, about 0.16 m large.
Mesh body() {
  Mesh mesh = pictures::box({-0.02f, 0.01f, 0}, {0.03f, 0.05f, 0.02f});
  const auto add = [&](const Mesh& more) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
    for (const auto& t : more.triangles)
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  };
  add(pictures::box({0.03f, -0.02f, 0.01f}, {0.02f, 0.01f, 0.07f}));
  add(pictures::sphere({0, 0.03f, 0.05f}, 0.03f, 12, false));
  return mesh;
}

/// The body, shining, and a floor of this half side under it, black.
Picture shining(double floor_m) {
  Picture p = hard::deep_picture(64, 16);
  const int lamp = pictures::add_matte(p.scene, {0, 0, 0});
  p.scene.materials.back().emits = true;
  p.scene.materials.back().emission.constant = {1, 1, 1};
  pictures::add_object(p.scene, body(), lamp, k_model_object_id);
  if (floor_m > 0) {
    const auto half = static_cast<float>(floor_m);
    pictures::add_object(p.scene, pictures::quad({0, 0, -0.08f}, {half, 0, 0}, {0, half, 0}),
                         pictures::add_matte(p.scene, {0, 0, 0}));
  }
  return p;
}

/// Aims from this far away, so that the body fills two thirds of the picture.
void aim(Camera& camera, Vec3d way, double distance_m) {
  camera.target = {0.004, -0.007, 0.02};
  camera.position = camera.target + normalized(way) * distance_m;
  camera.fov_deg = 2 * std::atan(0.12 / distance_m) * 180 / std::numbers::pi;
  camera.focus_distance_m = distance_m;
}

void expect_as_cast(const Picture& p) {
  SCOPED_TRACE(p.name);
  const int size = p.engine.width;
  const std::vector<double> exact = cast(p.scene, p.camera, size);
  EXPECT_GT(std::count_if(exact.begin(), exact.end(), [](double d) { return d > 0; }), size);
  Tracer tracer(pictures::tracer_options());
  tracer.set_scene(p.scene);
  const Geometry seen = tracer.trace_geometry(p.camera, size, size);
  const Film film = tracer.trace(p.camera, p.engine);
  const double distance = length(p.camera.position - p.camera.target);
  int wrong = 0, wrong_pictures = 0;
  double worst_depth = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto i = static_cast<std::size_t>(y * size + x);
      if (!is_inner(exact, size, x, y)) continue;
      const bool hit = exact[i] > 0;
      wrong += (seen.mask[i] != 0) != hit ? 1 : 0;
      wrong_pictures += std::fabs(film.rgb[3 * i] - (hit ? 1.0f : 0.0f)) > 1e-6f ? 1 : 0;
      if (hit && seen.mask[i] != 0)
        worst_depth = std::max(worst_depth, std::fabs(double{seen.depth[i]} - exact[i]));
    }
  EXPECT_EQ(wrong, 0);
  // The body has a crevice that is narrower than a pixel and between their middles.
  EXPECT_LE(wrong_pictures, 1);
  // Half an ulp of the distance, twice, and what a pixel's place is rounded by on a steep face.
  EXPECT_LT(worst_depth, 1.5e-7 * distance + 1e-5);
}

TEST(FarCameras, SeeWhatRaysCastInDoubleDo) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  for (const double distance : {1.0, 100.0, 1e4, 1e5, 1e6, k_farthest_m * 1.7})
    for (int i = 0; i < 3; ++i) {
      Picture p = shining(0);
      const Vec3d way = distance > k_farthest_m ? Vec3d{1, i == 1 ? -1.0 : 1.0, i == 2 ? -1.0 : 1.0}
                                                : Vec3d{u(random), u(random), u(random)};
      aim(p.camera, way, distance);
      p.name = "from " + std::to_string(distance) + " m, " + std::to_string(i);
      expect_as_cast(p);
    }
}

TEST(FarCameras, SeeTheBodyOnItsFloor) {
  // Whose corners are behind the camera, or beside the view: what is in view begins near the body.
  for (const double distance : {1e3, 1e5, 1e6})
    for (const double floor_m : {1.0, 1e3, 1e6}) {
      Picture p = shining(floor_m);
      aim(p.camera, {0.8, -0.5, 0.4}, distance);
      p.name = "from " + std::to_string(distance) + " m, floor of " + std::to_string(floor_m);
      expect_as_cast(p);
    }
}

TEST(FarCameras, OffTheirTargetToo) {
  // The body in a corner of a picture that looks past it.
  Picture p = shining(0);
  p.engine.width = p.engine.height = 128;
  aim(p.camera, {0.3, -0.7, 0.2}, 3e5);
  p.camera.target = p.camera.target + Vec3d{0.1, 0.05, -0.08};
  p.camera.fov_deg *= 2.2;
  p.name = "off its target";
  expect_as_cast(p);
}

TEST(FarCameras, HaveALensToo) {
  // In focus on the body, a lens of any width shows it as the pinhole does, but for the body's own
  // depth: a ten-thousandth of the distance apart, a lens of 1 / 1000 of it blurs by nothing.
  for (const double distance : {1e4, 1e6}) {
    Picture p = shining(0);
    aim(p.camera, {0.8, -0.5, 0.4}, distance);
    p.camera.lens_radius_m = 1e-3 * distance;
    p.name = "a lens, from " + std::to_string(distance) + " m";
    expect_as_cast(p);
  }
}

TEST(FarCameras, OutOfFocusTheDiscIsTheLens) {
  // A point that shines is a disc of radius lens |1 - depth / focus| at its depth: with the focus
  // twice as far, half the lens. Seen from 1e5 m, a lens of 0.08 m makes one of 0.04 m.
  constexpr int k_size = 64;
  Picture p = hard::deep_picture(k_size, 256);
  const int lamp = pictures::add_matte(p.scene, {0, 0, 0});
  p.scene.materials.back().emits = true;
  p.scene.materials.back().emission.constant = {1, 1, 1};
  pictures::add_object(p.scene, pictures::sphere({}, 0.004f, 12, false), lamp);
  p.camera.position = {8e4, -6e4, 0};
  p.camera.target = {};
  p.camera.fov_deg = 2 * std::atan(0.06 / 1e5) * 180 / std::numbers::pi;
  p.camera.lens_radius_m = 0.08;
  p.camera.focus_distance_m = 2e5;
  hard::everywhere(p, [](const Film& film) {
    double sum = 0, outside = 0, second = 0;
    for (int y = 0; y < k_size; ++y)
      for (int x = 0; x < k_size; ++x) {
        const double v = double{film.rgb[static_cast<std::size_t>(3 * (y * k_size + x))]};
        const double r = std::hypot(x + 0.5 - k_size / 2, y + 0.5 - k_size / 2) * 0.12 / k_size;
        sum += v;
        second += v * r * r;
        if (r > 0.044 + 0.12 / k_size) outside += v;
      }
    EXPECT_EQ(outside, 0);
    // A disc's mean squared radius is half its own; the lamp's adds to it.
    EXPECT_NEAR(second / sum, (0.04 * 0.04 + 0.004 * 0.004) / 2, 0.03 * 0.04 * 0.04 / 2);
  });
}

TEST(RayStart, IsTheCameraWhereAPixelIsWide) {
  Picture p = shining(0);
  EXPECT_EQ(ray_start_m(p.scene, Camera{}, 512, 512), 0);
  EXPECT_EQ(ray_start_m(p.scene, Camera{}, 16384, 16384), 0);
  aim(p.camera, {1, 0, 0}, 1e6);
  Camera wide = p.camera;
  wide.fov_deg = 49;
  EXPECT_EQ(ray_start_m(p.scene, wide, 512, 512), 0);
}

TEST(RayStart, IsJustBeforeTheFirstThingInView) {
  Picture p = shining(1e6);
  aim(p.camera, {0.8, -0.5, 0.4}, 1e5);
  const double start = ray_start_m(p.scene, p.camera, 64, 64);
  EXPECT_LT(start, 1e5 - 0.1);
  EXPECT_GT(start, 1e5 - 1);
  // Something before it, then beside the view.
  Scene scene = p.scene;
  const Vec3d half_way = p.camera.position + (p.camera.target - p.camera.position) * 0.5;
  pictures::add_object(scene, pictures::box(to_float(half_way), {0.01f, 0.01f, 0.01f}), 0);
  EXPECT_NEAR(ray_start_m(scene, p.camera, 64, 64), 5e4, 1);
  for (Vec3& v : scene.objects.back().mesh.positions)
    v.z += 1;
  EXPECT_EQ(ray_start_m(scene, p.camera, 64, 64), start);
  // Nothing in view, or all behind.
  p.camera.target = p.camera.position * 2;
  EXPECT_EQ(ray_start_m(p.scene, p.camera, 64, 64), 0);
}

}  // namespace
}  // namespace ds
