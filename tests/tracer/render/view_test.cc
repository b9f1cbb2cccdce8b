// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/view.h"

#include "tests/render/pictures.h"
#include "tracer/base/error.h"
#include "tracer/base/tan_half.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ds {
namespace {

Camera looking(Vec3 from, Vec3 at, Vec3 up = {0, 0, 1}) {
  Camera camera;
  camera.position = to_double(from);
  camera.target = to_double(at);
  camera.up = to_double(up);
  return camera;
}

TEST(CameraFrame, IsRightHandedAndOrthonormal) {
  for (const Vec3 from : {Vec3{1, 2, 3}, Vec3{-5, 0.1f, 0}, Vec3{0, 1e-3f, 2}, Vec3{1e5f, 0, 1}}) {
    const CameraFrame f = camera_frame(looking(from, {0, 0, 0}));
    EXPECT_NEAR(length(f.right), 1, 1e-12);
    EXPECT_NEAR(length(f.up), 1, 1e-12);
    EXPECT_NEAR(dot(f.right, f.up), 0, 1e-12);
    EXPECT_NEAR(dot(f.right, f.forward), 0, 1e-12);
    EXPECT_NEAR(length(cross(f.right, f.up) + f.forward), 0,
                1e-12);  // looking along -z of its axes
    EXPECT_NEAR(f.right.z, 0, 1e-12);
    EXPECT_GE(f.up.z, 0);
  }
}

TEST(CameraFrame, LookingStraightDownOrUp) {
  for (const float z : {1.0f, -1.0f}) {
    const CameraFrame f = camera_frame(looking({0, 0, z}, {0, 0, 0}));
    EXPECT_NEAR(f.forward.z, -double{z}, 1e-12);
    EXPECT_NEAR(f.up.y, 1, 1e-12);
    EXPECT_NEAR(f.right.x, double{z}, 1e-12);
  }
  const CameraFrame along_y = camera_frame(looking({0, 1, 0}, {0, 0, 0}, {0, 1, 0}));
  EXPECT_NEAR(along_y.up.z, 1, 1e-12);
}

TEST(CameraFrame, ATargetAtThePositionIsAnError) {
  EXPECT_THROW(camera_frame(looking({1, 2, 3}, {1, 2, 3})), Error);
}

TEST(TanHalf, EqualsTan) {
  for (double degrees = 0.01; degrees < 180; degrees += 0.7) {
    const double want = std::tan(degrees * std::numbers::pi / 360);
    // Near 180 degrees tan multiplies the rounding of its argument, in libm's case as in ours.
    EXPECT_NEAR(tan_half(degrees) / want, 1, degrees < 170 ? 1e-13 : 1e-12) << degrees;
  }
}

TEST(ViewData, TheFieldOfViewSpansTheLongerSide) {
  EngineSettings engine;
  const Camera camera = looking({0, -1, 0}, {0, 0, 0});
  const double half = std::tan(camera.fov_deg * std::numbers::pi / 360);
  for (const auto& [width, height] : {std::pair{400, 100}, {100, 400}, {64, 64}}) {
    engine.width = width;
    engine.height = height;
    const kernels::ViewData v = view_data(camera, engine);
    EXPECT_NEAR(double{v.right[0]}, half * std::min(1.0, width / double(height)), 1e-6);
    EXPECT_NEAR(double{v.up[2]}, half * std::min(1.0, height / double(width)), 1e-6);
  }
}

TEST(ViewData, ParallelRaysStartInTheCamerasPlane) {
  EngineSettings engine;
  for (std::size_t type = 0; type < camera_types().size(); ++type) {
    if (camera_types()[type].host.span != kernels::CameraSpan::extent_m) continue;
    Camera camera = looking({0, -1, 0}, {0, 0, 0});
    camera.type = static_cast<int>(type);
    camera.extent_m = 0.5;
    for (const auto& [width, height] : {std::pair{400, 100}, {100, 400}, {64, 64}})
      for (const double start_m : {0.0, 0.75}) {
        engine.width = width;
        engine.height = height;
        const kernels::ViewData v = view_data(camera, engine, start_m);
        EXPECT_NEAR(double{v.start_right[0]}, 0.25 * std::min(1.0, width / double(height)), 1e-7);
        EXPECT_NEAR(double{v.start_up[2]}, 0.25 * std::min(1.0, height / double(width)), 1e-7);
        EXPECT_NEAR(double{v.start[1]}, start_m - 1, 1e-7);
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_EQ(v.right[axis], 0);
          EXPECT_EQ(v.up[axis], 0);
        }
        EXPECT_EQ(v.forward[1], 1);
      }
    EXPECT_NE(canonical_camera(camera), canonical_camera(looking({0, -1, 0}, {0, 0, 0})));
    const std::string text = canonical_camera(camera);
    camera.fov_deg = 20;
    EXPECT_EQ(canonical_camera(camera), text);
    camera.extent_m = 0.25;
    EXPECT_NE(canonical_camera(camera), text);
  }
}

TEST(CanonicalCamera, APinholeHasNoFocus) {
  Camera camera;
  const std::string text = canonical_camera(camera);
  camera.focus_distance_m *= 2;
  EXPECT_EQ(canonical_camera(camera), text);
  camera.lens_radius_m = 0.01;
  const std::string lens = canonical_camera(camera);
  EXPECT_NE(lens, text);
  camera.focus_distance_m *= 2;
  EXPECT_NE(canonical_camera(camera), lens);
}

TEST(CanonicalEngine, EverySettingIsInIt) {
  const pictures::Picture p = pictures::all_effects()[0];
  const std::string usual = canonical_engine(p.scene, p.camera, p.engine);
  const auto expect_changed = [&](auto EngineSettings::*member, auto value) {
    EngineSettings engine = p.engine;
    engine.*member = value;
    EXPECT_NE(canonical_engine(p.scene, p.camera, engine), usual);
  };
  for (int EngineSettings::*member :
       {&EngineSettings::width, &EngineSettings::height, &EngineSettings::spp,
        &EngineSettings::depth_total, &EngineSettings::depth_diffuse, &EngineSettings::depth_glossy,
        &EngineSettings::depth_specular, &EngineSettings::roulette_depth})
    expect_changed(member, 99);
  expect_changed(&EngineSettings::roulette_cap, 0.25f);
  expect_changed(&EngineSettings::filter_width, 2.5f);
  expect_changed(&EngineSettings::seed, std::uint64_t{1} << 40);
  expect_changed(&EngineSettings::math, MathMode::fast);
}

}  // namespace
}  // namespace ds
