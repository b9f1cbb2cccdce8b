// SPDX-License-Identifier: Apache-2.0
#include "manifests/camera_geometry.h"

#include "tracer/base/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ds {
namespace {

TEST(SinDeg, AgreesWithTheLibraryInLongDouble) {
  for (double degrees = -800; degrees <= 800; degrees += 0.37) {
    const long double radians =
        static_cast<long double>(degrees) * std::numbers::pi_v<long double> / 180;
    // 2 ulp of 1, as the header says.
    EXPECT_NEAR(sin_deg(degrees), static_cast<double>(std::sin(radians)), 4.5e-16) << degrees;
    EXPECT_NEAR(cos_deg(degrees), static_cast<double>(std::cos(radians)), 4.5e-16) << degrees;
  }
}

TEST(SinDeg, IsExactAtQuarterTurns) {
  for (int turn = -3; turn <= 3; ++turn) {
    const double degrees = 360.0 * turn;
    EXPECT_EQ(sin_deg(degrees), 0);
    EXPECT_EQ(sin_deg(degrees + 90), 1);
    EXPECT_EQ(sin_deg(degrees + 180), 0);
    EXPECT_EQ(sin_deg(degrees + 270), -1);
    EXPECT_EQ(cos_deg(degrees), 1);
    EXPECT_EQ(cos_deg(degrees + 90), 0);
    EXPECT_EQ(cos_deg(degrees + 180), -1);
    EXPECT_EQ(cos_deg(degrees + 270), 0);
  }
}

TEST(CameraIntrinsics, SpanTheAngleOverTheLongerSide) {
  // 90 degrees: the focal length is half the longer side.
  const auto wide = camera_intrinsics(90, 640, 480);
  EXPECT_NEAR(wide[0], 320, 1e-12);
  EXPECT_EQ(wide[4], wide[0]);
  EXPECT_EQ(wide[2], 320);
  EXPECT_EQ(wide[5], 240);
  EXPECT_EQ(wide[8], 1);
  const auto tall = camera_intrinsics(90, 480, 640);
  EXPECT_NEAR(tall[0], 320, 1e-12);
  // The thesis's lens: 256 / tan(24.5 degrees).
  EXPECT_NEAR(camera_intrinsics(49, 512, 512)[0], 561.740731178250, 1e-10);
}

/// World point to pixel by K and the inverse of the pose, as a user of the manifest does it.
std::array<double, 2> project(const Camera& camera, int width, int height, Vec3d point) {
  const auto pose = camera_pose(camera);
  const auto k = camera_intrinsics(camera.fov_deg, width, height);
  const Vec3d d = point - Vec3d{pose[3], pose[7], pose[11]};
  const double x = pose[0] * d.x + pose[4] * d.y + pose[8] * d.z;
  const double y = pose[1] * d.x + pose[5] * d.y + pose[9] * d.z;
  const double z = pose[2] * d.x + pose[6] * d.y + pose[10] * d.z;
  return {k[0] * x / z + k[2], k[4] * y / z + k[5]};
}

TEST(CameraPose, HasXRightYDownZForward) {
  Camera camera;  // at +X, looking at the origin: the world's +Y is to the right, +Z up
  camera.position = {2, 0, 0};
  const auto pose = camera_pose(camera);
  EXPECT_EQ(pose, (std::array<double, 16>{0, 0, -1, 2,  //
                                          1, 0, 0, 0,   //
                                          0, -1, 0, 0,  //
                                          0, 0, 0, 1}));
  camera.fov_deg = 90;
  const auto centre = project(camera, 100, 80, {0, 0, 0});
  EXPECT_NEAR(centre[0], 50, 1e-12);
  EXPECT_NEAR(centre[1], 40, 1e-12);
  const auto right =
      project(camera, 100, 80, {0, 2, 0});  // 45 degrees to the right: the picture's right edge
  EXPECT_NEAR(right[0], 100, 1e-12);
  const auto above = project(camera, 100, 80, {0, 0, 1});
  EXPECT_LT(above[1], 40);
}

TEST(CameraPose, IsARotationForAnyView) {
  Camera camera;
  camera.position = {0.1, -0.7, 0.4};
  camera.target = {0.3, 0.2, -0.1};
  const auto m = camera_pose(camera);
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      const double product = m[a] * m[b] + m[4 + a] * m[4 + b] + m[8 + a] * m[8 + b];
      EXPECT_NEAR(product, a == b ? 1 : 0, 1e-15);
    }
  }
  const double determinant = m[0] * (m[5] * m[10] - m[6] * m[9]) -
                             m[1] * (m[4] * m[10] - m[6] * m[8]) +
                             m[2] * (m[4] * m[9] - m[5] * m[8]);
  EXPECT_NEAR(determinant, 1, 1e-15);
  EXPECT_LT(m[9], 0);  // y is down
}

TEST(CameraPose, RefusesACameraWithoutAFrame) {
  Camera camera;
  camera.position = {0, 0, 1};
  EXPECT_THROW(camera_pose(camera), Error);
  camera.up = {0, 1, 0};
  EXPECT_NO_THROW(camera_pose(camera));
  camera.position = camera.target;
  EXPECT_THROW(camera_pose(camera), Error);
}

}  // namespace
}  // namespace ds
