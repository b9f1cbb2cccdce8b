// SPDX-License-Identifier: Apache-2.0
// Surfaces that lie on each other. What lies on a floor is seen as if the floor were
// infinitesimally lower, however rays round: in masks, depths and pictures, and through glass.
#include "manifests/camera_geometry.h"
#include "tests/hard/everywhere.h"
#include "tests/render/ray_caster.h"
#include "tracer/scene/sdl.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ds {
namespace {

using pictures::Picture;

/// A rotation by Euler angles, then a move. The identity changes no bit.
struct Pose {
  const char* name;
  double yaw = 0, pitch = 0, roll = 0;
  Vec3d move{};

  Vec3d turn(Vec3d v) const {
    v = {v.x * std::cos(yaw) - v.y * std::sin(yaw), v.x * std::sin(yaw) + v.y * std::cos(yaw), v.z};
    v = {v.x * std::cos(pitch) + v.z * std::sin(pitch), v.y,
         v.z * std::cos(pitch) - v.x * std::sin(pitch)};
    return {v.x, v.y * std::cos(roll) - v.z * std::sin(roll),
            v.y * std::sin(roll) + v.z * std::cos(roll)};
  }
  Vec3d operator()(Vec3d p) const { return turn(p) + move; }
};

const Pose k_level{"level"};
const Pose k_tilted{"tilted", 0.3, 0.7, -0.4, {0.13, -0.21, 0.37}};
const Pose k_column{"against a column", 0.3, M_PI / 2, 0.4, {0.1, 0.2, 0.3}};

constexpr double k_ground = -0.0574;

/// A square of side 2 `half` about (x, y) at height z, of so many tiles along an edge.
Mesh square(double x, double y, double z, double half, std::uint32_t tiles, const Pose& pose) {
  Mesh mesh;
  for (std::uint32_t j = 0; j <= tiles; ++j)
    for (std::uint32_t i = 0; i <= tiles; ++i)
      mesh.positions.push_back(
          to_float(pose({x + half * (2.0 * i / tiles - 1), y + half * (2.0 * j / tiles - 1), z})));
  for (std::uint32_t j = 0; j < tiles; ++j)
    for (std::uint32_t i = 0; i < tiles; ++i) {
      const std::uint32_t a = j * (tiles + 1) + i, b = a + tiles + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

void look(Picture& p, const Pose& pose, Vec3d from, Vec3d to) {
  p.camera.position = pose(from);
  p.camera.target = pose(to);
  p.camera.up = pose.turn({0, 0, 1});
}

void look_from(Picture& p, const Pose& pose, double elevation_deg, double distance_m) {
  const double e = elevation_deg * M_PI / 180;
  const Vec3d middle{0.01, -0.02, k_ground};
  look(p, pose,
       middle + Vec3d{std::cos(e) * std::cos(0.57), std::cos(e) * std::sin(0.57), std::sin(e)} *
                    distance_m,
       middle);
}

/// Planar depth of the mesh alone by pixel, 0 where it is not met.
std::vector<double> cast(const Mesh& mesh, const Camera& camera, int size) {
  Object object;
  object.mesh = mesh;
  std::vector<double> depth;
  for (const ray_caster::Hit& hit :
       ray_caster::cast({object}, {true}, camera_intrinsics(camera.fov_deg, size, size),
                        camera_pose(camera), size, size))
    depth.push_back(hit.depth);
  return depth;
}

/// Whether the pixel and all within two of it are met.
bool is_inner(const std::vector<double>& depth, int size, int pixel) {
  for (int y = pixel / size - 2; y <= pixel / size + 2; ++y)
    for (int x = pixel % size - 2; x <= pixel % size + 2; ++x)
      if (x >= 0 && y >= 0 && x < size && y < size &&
          !(depth[static_cast<std::size_t>(y * size + x)] > 0))
        return false;
  return true;
}

/// A plate of 0.5 on a floor of 0.2, under a sky of 1. The model comes last, as in composed scenes.
Picture plate_on_floor(const Pose& pose, double floor_half, std::uint32_t floor_tiles,
                       std::uint32_t plate_tiles, double gap = 0) {
  Picture p = hard::deep_picture(48, 4);
  p.engine.depth_total = 1;
  p.engine.filter_width = 1;
  pictures::add_object(p.scene, square(0.02, 0.01, k_ground, floor_half, floor_tiles, pose),
                       pictures::add_matte(p.scene, {0.2f, 0.2f, 0.2f}));
  pictures::add_object(p.scene, square(0, 0, k_ground + gap, 0.08, plate_tiles, pose),
                       pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f}), k_model_object_id);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  p.camera.fov_deg = 30;
  return p;
}

/// Half the share that each pixel has of the plate: the floor is black, and a millimetre lower,
/// which no rounding bridges.
Film plate_alone(Picture p, const Pose& pose) {
  for (Vec3& v : p.scene.objects[0].mesh.positions)
    v = to_float(to_double(v) - pose.turn({0, 0, 1e-3}));
  pictures::set_input(p.scene, 0, "kd", {});
  return pictures::trace(p);
}

void expect_the_plate_is_seen(const Picture& p, const Pose& pose) {
  const int size = p.engine.width;
  const std::vector<double> floor = cast(p.scene.objects[0].mesh, p.camera, size);
  const std::vector<double> right = cast(p.scene.objects[1].mesh, p.camera, size);
  const Film plate = plate_alone(p, pose);
  Tracer tracer(pictures::tracer_options());
  tracer.set_scene(p.scene);
  const Geometry seen = tracer.trace_geometry(p.camera, size, size);
  const Film film = tracer.trace(p.camera, p.engine);
  int wrong = 0, met = 0;
  double off_depth = 0, off_picture = 0;
  for (int i = 0; i < size * size; ++i) {
    const auto at = static_cast<std::size_t>(i);
    met += right[at] > 0;
    wrong += (right[at] > 0) != (seen.mask[at] != 0);
    if (right[at] > 0 && seen.mask[at] != 0)
      off_depth = std::max(off_depth, std::fabs(double{seen.depth[at]} / right[at] - 1));
    // The same samples, so the same shares. Beyond the floor is the sky.
    if (is_inner(floor, size, i))
      off_picture = std::max(off_picture, std::fabs(double{film.rgb[3 * at]} -
                                                    (0.2 + 0.6 * double{plate.rgb[3 * at]})));
  }
  EXPECT_GT(met, 20) << p.name;
  EXPECT_EQ(wrong, 0) << p.name << ": mask, of " << met;
  EXPECT_LT(off_depth, 1e-5) << p.name;
  EXPECT_LT(off_picture, 1e-6) << p.name;
}

TEST(Contact, AModelThatLiesOnAFloorIsSeen) {
  for (const Pose& pose : {k_level, k_tilted, k_column})
    for (const double floor_half : {0.4, 10.0, 300.0})
      for (const double elevation : {85.0, 50.0, 10.0, 2.0}) {
        const std::uint32_t tiles = elevation > 20 ? 1 : 7;
        Picture p = plate_on_floor(pose, floor_half, tiles, 8 - tiles);
        p.name = std::string(pose.name) + ", floor of " + std::to_string(floor_half) + " m, " +
                 std::to_string(elevation) + " degrees";
        look_from(p, pose, elevation, 0.4);
        expect_the_plate_is_seen(p, pose);
      }
}

TEST(Contact, AModelThatAllButLiesOnAFloorIsSeen) {
  // By less than a ray can tell from a corner of the floor.
  for (const double gap : {1e-8, 1e-7, 1e-6}) {
    Picture p = plate_on_floor(k_tilted, 10, 1, 3, gap);
    p.name = "gap of " + std::to_string(gap);
    look_from(p, k_tilted, 20, 0.4);
    expect_the_plate_is_seen(p, k_tilted);
  }
}

TEST(Contact, OfTwoFacesTheLesserLiesOnTop) {
  // Neither is the model's; in either order. From below too, where it is as good as the other.
  for (const Pose& pose : {k_level, k_tilted})
    for (const bool swapped : {false, true})
      for (const double elevation : {35.0, -35.0}) {
        Picture p = plate_on_floor(pose, 1, 3, 2);
        p.scene.objects[1].id = 2;
        if (swapped) std::swap(p.scene.objects[0], p.scene.objects[1]);
        p.engine.width = p.engine.height = 12;
        p.camera.fov_deg = 5;
        look_from(p, pose, elevation, 0.4);
        p.name = "carpet";
        hard::everywhere(
            p, [](const Film& film) { EXPECT_LT(hard::worst_difference(film, 0.5), 1e-6); });
      }
}

TEST(Contact, WhatTheCameraDoesNotSeeHidesNothing) {
  for (const Pose& pose : {k_level, k_tilted}) {
    Picture p = plate_on_floor(pose, 1, 3, 2);
    p.scene.objects[1].id = 2;
    p.scene.objects[1].camera_invisible = true;
    p.engine.width = p.engine.height = 12;
    p.camera.fov_deg = 5;
    look_from(p, pose, 35, 0.4);
    p.name = "unseen carpet";
    hard::everywhere(p,
                     [](const Film& film) { EXPECT_LT(hard::worst_difference(film, 0.2), 1e-6); });
    Tracer tracer(pictures::tracer_options());
    tracer.set_scene(p.scene);
    const Geometry geometry = tracer.trace_geometry(p.camera, 12, 12);
    const std::vector<double> floor = cast(p.scene.objects[0].mesh, p.camera, 12);
    for (std::size_t i = 0; i < floor.size(); ++i)
      EXPECT_NEAR(double{geometry.depth[i]} / floor[i], 1, 1e-5);
  }
}

/// A body of glass on a floor that may be lower by `gap`; of no height it is a sheet. The lamp below
/// the floor must not shine through it.
Picture glass_on_floor(const std::string& glass, const Pose& pose, Vec3 half, double gap) {
  Picture p = hard::deep_picture(12, 256);
  pictures::add_object(p.scene, square(0.02, 0.01, k_ground - gap, 10, 1, pose),
                       pictures::add_matte(p.scene, {0.8f, 0.5f, 0.2f}));
  const auto ground = static_cast<float>(k_ground);
  Mesh body = pictures::box({0, 0, ground + half.z}, half);
  for (Vec3& v : body.positions)
    v = to_float(pose(to_double({v.x, v.y, v.z < ground + half.z ? ground : v.z})));
  if (half.z == 0) body = square(0, 0, k_ground, double{half.x}, 1, pose);
  pictures::add_object(p.scene, body, pictures::add_material(p.scene, glass), k_model_object_id);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  p.scene.lights.push_back(pictures::point_light(to_float(pose({0.3, 0.2, 0.8})), {1, 1, 1}));
  p.scene.lights.push_back(pictures::point_light(to_float(pose({0, 0, -0.8})), {9, 9, 9}));
  p.camera.fov_deg = 12;
  p.engine.depth_total = 12;
  p.engine.depth_diffuse = p.engine.depth_glossy = p.engine.depth_specular = 12;
  look_from(p, pose, 60, 0.5);
  return p;
}

TEST(Contact, GlassOnAFloorShowsTheFloor) {
  // As with a gap of a thousandth of the body, which by itself is worth less than the bound.
  for (const std::string glass : {"glass", "roughglass"})
    for (const Pose& pose : {k_level, k_tilted})
      for (const Vec3 half :
           {Vec3{0.08f, 0.08f, 0.08f}, Vec3{0.08f, 0.08f, 0.002f}, Vec3{0.08f, 0.08f, 0}}) {
        const pictures::Estimate on = pictures::estimate(glass_on_floor(glass, pose, half, 0), 8);
        const pictures::Estimate off =
            pictures::estimate(glass_on_floor(glass, pose, half, 1e-4), 8, 99);
        EXPECT_NEAR(on.mean, off.mean, 4 * std::hypot(on.error, off.error) + 0.004 * off.mean)
            << glass << ", " << pose.name << ", " << half.z;
      }
}

/// A lamp on a black wall that may be farther by `gap`, and a grey plane before it.
Picture lamp_on_wall(const Pose& pose, double gap) {
  Picture p = hard::deep_picture(12, 64);
  const int black = pictures::add_matte(p.scene, {0, 0, 0});
  const int lamp = pictures::add_matte(p.scene, {0, 0, 0});
  p.scene.materials[static_cast<std::size_t>(lamp)].emits = true;
  p.scene.materials[static_cast<std::size_t>(lamp)].emission.constant = {5, 5, 5};
  pictures::add_object(p.scene, square(0.02, 0.01, k_ground - gap, 50, 1, pose), black);
  pictures::add_object(p.scene, square(0, 0, k_ground, 0.05, 2, pose), lamp);
  pictures::add_object(p.scene, pictures::inside_out(square(0, 0, k_ground + 0.002, 1, 1, pose)),
                       pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f}));
  p.camera.fov_deg = 60;
  look(p, pose, {0.03, 0.01, k_ground + 0.0003}, {0.031, 0.012, k_ground + 0.002});
  p.engine.depth_total = 1;
  return p;
}

TEST(Contact, ALampOnAWallShinesAsOneJustOffIt) {
  for (const Pose& pose : {k_level, k_tilted}) {
    const pictures::Estimate on = pictures::estimate(lamp_on_wall(pose, 0), 8);
    const pictures::Estimate off = pictures::estimate(lamp_on_wall(pose, 1e-3), 8, 99);
    EXPECT_GT(on.mean, 1);
    EXPECT_NEAR(on.mean, off.mean, 4 * std::hypot(on.error, off.error)) << pose.name;
  }
}

TEST(Contact, WhatLiesOnALampHidesItsLight) {
  // A black plate on a shining floor, and a grey plane over both.
  for (const Pose& pose : {k_level, k_tilted}) {
    const auto picture = [&](double gap) {
      Picture p = hard::deep_picture(12, 64);
      const int lamp = pictures::add_matte(p.scene, {0, 0, 0});
      p.scene.materials[static_cast<std::size_t>(lamp)].emits = true;
      p.scene.materials[static_cast<std::size_t>(lamp)].emission.constant = {5, 5, 5};
      pictures::add_object(p.scene, square(0.02, 0.01, k_ground - gap, 0.2, 2, pose), lamp);
      pictures::add_object(p.scene, square(0, 0, k_ground, 0.08, 3, pose),
                           pictures::add_matte(p.scene, {0, 0, 0}), k_model_object_id);
      pictures::add_object(p.scene, pictures::inside_out(square(0, 0, k_ground + 0.1, 1, 1, pose)),
                           pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f}));
      p.camera.fov_deg = 60;
      look(p, pose, {0.03, 0.01, k_ground + 0.02}, {0.031, 0.012, k_ground + 0.1});
      p.engine.depth_total = 1;
      return p;
    };
    const pictures::Estimate on = pictures::estimate(picture(0), 8);
    const pictures::Estimate off = pictures::estimate(picture(1e-4), 8, 99);
    EXPECT_GT(on.mean, 0.1);
    // A thousandth of the distance is worth less than half a percent.
    EXPECT_NEAR(on.mean, off.mean, 4 * std::hypot(on.error, off.error) + 0.005 * off.mean)
        << pose.name;
  }
}

TEST(Contact, NoTreeChangesABit) {
  for (Picture p : {plate_on_floor(k_tilted, 10, 9, 7), plate_on_floor(k_level, 1, 1, 1),
                    glass_on_floor("glass", k_tilted, {0.08f, 0.08f, 0.02f}, 0)}) {
    p.engine.spp = 16;
    look_from(p, k_tilted, 15, 0.4);
    std::string film;
    std::vector<float> depth;
    for (const bool high : {false, true})
      for (const int width : {8, 4, 2}) {
        TracerOptions options = pictures::tracer_options();
        options.high_quality_bvh = high;
        options.bvh_width = width;
        Tracer tracer(options);
        tracer.set_scene(p.scene);
        const std::string hash = pictures::film_hash(tracer.trace(p.camera, p.engine));
        const Geometry geometry = tracer.trace_geometry(p.camera, 48, 48);
        if (film.empty()) {
          film = hash;
          depth = geometry.depth;
        }
        EXPECT_EQ(hash, film) << width;
        EXPECT_EQ(geometry.depth, depth) << width;
      }
  }
}

}  // namespace
}  // namespace ds
