// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/camera_sets.h"

#include "manifests/camera_geometry.h"
#include "tests/builder/recipe_folder.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace ds {
namespace {

using testing::ElementsAre;

void expect_near(Vec3d found, Vec3d wanted, double tolerance) {
  EXPECT_NEAR(found.x, wanted.x, tolerance);
  EXPECT_NEAR(found.y, wanted.y, tolerance);
  EXPECT_NEAR(found.z, wanted.z, tolerance);
}

TEST(HalfDodecahedron, HasTheThesissPositions) {
  const auto raw = half_dodecahedron(1.732, false);
  ASSERT_EQ(raw.size(), 14u);
  expect_near(raw[0], {1.618, 0, 0}, 1e-15);
  expect_near(raw[5], {.618, -1.618, 0}, 1e-15);
  expect_near(raw[9], {-1.618, 0, .618}, 1e-15);
  expect_near(raw[10], {-1, -1, 1}, 1e-15);
  expect_near(raw[13], {0, -.618, 1.618}, 1e-15);

  const auto unit = half_dodecahedron(0.252, true);
  for (std::size_t i = 0; i < 14; ++i) {
    EXPECT_NEAR(length(unit[i]), 0.252, 1e-16);
    expect_near(normalized(unit[i]), normalized(raw[i]), 1e-15);
    EXPECT_GE(unit[i].z, 0);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(length(unit[i] - unit[j]), 0.09);
  }
}

TEST(Orbit, GoesRoundCounterClockwise) {
  const auto positions = orbit(4, 2, 30, 90);
  ASSERT_EQ(positions.size(), 4u);
  const double r = std::sqrt(3.0);  // 2 cos 30
  expect_near(positions[0], {0, r, 1}, 1e-15);
  expect_near(positions[1], {-r, 0, 1}, 1e-15);
  expect_near(positions[2], {0, -r, 1}, 1e-15);
  expect_near(positions[3], {r, 0, 1}, 1e-15);
}

TEST(Hemisphere, SpreadsItsViewsEvenly) {
  const auto positions = hemisphere(100, 3, 0);
  ASSERT_EQ(positions.size(), 100u);
  Vec3d mean;
  double nearest = 6;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    EXPECT_NEAR(length(positions[i]), 3, 1e-14);
    EXPECT_GT(positions[i].z, 0);
    mean = mean + positions[i] * 0.01;
    for (std::size_t j = 0; j < i; ++j)
      nearest = std::min(nearest, length(positions[i] - positions[j]));
  }
  // Centroid of a half sphere's surface: half the radius up.
  expect_near(mean, {0, 0, 1.5}, 0.05);
  // 100 points on 2 pi r^2 leave each a disc of radius r sqrt(2 / 100); neighbours are at least 1.2
  // of it apart.
  EXPECT_GT(nearest, 1.2 * 3 * std::sqrt(0.02));
  expect_near(hemisphere(1, 1, 0)[0], {std::sqrt(0.75), 0, 0.5}, 1e-15);
}

class CameraSetsTest : public testing::Test {
 protected:
  std::vector<Camera> cameras(std::string_view text) const { return folder_.read(text).cameras; }
  RecipeFolder folder_;
};

TEST_F(CameraSetsTest, AreFocusedOnTheOriginThroughAThinLens) {
  for (const Camera& camera : cameras("camera.lens_radius_m = 0.002")) {
    EXPECT_NEAR(camera.focus_distance_m, 0.252, 1e-15);
    EXPECT_EQ(camera.lens_radius_m, 0.002);
    EXPECT_EQ(camera.target, (Vec3d{}));
    EXPECT_EQ(camera.fov_deg, 49);
    EXPECT_NO_THROW(camera_pose(camera));
  }
}

TEST_F(CameraSetsTest, StandAroundTheTarget) {
  const auto around = cameras(
      "camera.set = \"orbit\"\ncamera.count = 2\ncamera.elevation_deg = 0\n"
      "camera.distance_m = 2\ncamera.target = [0, 0, 1]\ncamera.focus = \"target\"");
  expect_near(around[0].position, {2, 0, 1}, 1e-15);
  EXPECT_EQ(around[0].target, (Vec3d{0, 0, 1}));
  EXPECT_NEAR(around[0].focus_distance_m, 2, 1e-15);
}

TEST_F(CameraSetsTest, FocusAlongTheAxisNotAlongTheRay) {
  // From (2, 0, 0) towards (0, 2, 0): the origin is sqrt(2) along the axis, 2 away.
  constexpr std::string_view k_aside =
      "camera.set = \"list\"\ncamera.positions = [[2, 0, 0]]\ncamera.target = [0, 2, 0]\n";
  EXPECT_NEAR(cameras(k_aside)[0].focus_distance_m, std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(cameras(std::string(k_aside) + "camera.focus = \"target\"")[0].focus_distance_m,
              std::sqrt(8.0), 1e-15);
  EXPECT_EQ(
      cameras(std::string(k_aside) + "camera.focus = \"distance\"\ncamera.focus_distance_m = 7")[0]
          .focus_distance_m,
      7);
}

TEST_F(CameraSetsTest, HaveAFrameStraightFromAboveToo) {
  const auto above =
      cameras("camera.set = \"list\"\ncamera.positions = [[0, 0, 1], [1, 0, 0], [0, 0, -2]]");
  EXPECT_EQ(above[0].up, (Vec3d{0, 1, 0}));
  EXPECT_EQ(above[1].up, (Vec3d{0, 0, 1}));
  EXPECT_EQ(above[2].up, (Vec3d{0, 1, 0}));
  const auto pose = camera_pose(above[0]);  // x right, y down = -Y, z forward = -Z
  EXPECT_EQ(pose[0], 1);
  EXPECT_EQ(pose[5], -1);
  EXPECT_EQ(pose[10], -1);
}

TEST_F(CameraSetsTest, MayBeUsedInPart) {
  const Recipe all = folder_.read();
  const Recipe some = folder_.read("camera.views = [12, 0]");
  EXPECT_THAT(some.view_names, ElementsAre("0", "12"));
  EXPECT_EQ(some.cameras[1].position, all.cameras[12].position);
  EXPECT_EQ(folder_.findings("camera.views = [14, 2, 2, -1]"),
            "r.toml:4:27: camera.views must be a list of integers >= 0, got -1");
  EXPECT_EQ(folder_.findings("camera.views = [14, 2, 2]"),
            "r.toml:4:17: camera.views must be below the 14 views of the set, got 14\n"
            "r.toml:4:24: camera.views must name a view once, got 2 again");
}

TEST_F(CameraSetsTest, APinholeNeedsNoFocus) {
  const std::string_view k_behind =
      "camera.set = \"list\"\ncamera.positions = [[1, 0, 0]]\ncamera.target = [3, 0, 0]\n";
  testing::internal::CaptureStderr();
  EXPECT_EQ(cameras(k_behind)[0].focus_distance_m, 2);
  EXPECT_EQ(cameras(std::string(k_behind) + "camera.focus = \"origin\"")[0].focus_distance_m, 2);
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::Not(testing::HasSubstr("camera.focus")));
  testing::internal::CaptureStderr();
  const std::string chosen =
      "camera.lens_radius_m = 0\ncamera.focus = \"distance\"\ncamera.focus_distance_m = 7";
  EXPECT_EQ(cameras(std::string(k_behind) + chosen)[0].focus_distance_m, 7);
  EXPECT_THAT(
      testing::internal::GetCapturedStderr(),
      testing::HasSubstr("r.toml:8:16: camera.focus has no effect with camera.lens_radius_m "
                         "= 0, a pinhole: all is sharp\n"));
}

TEST_F(CameraSetsTest, ReportWhatCannotBeSeen) {
  EXPECT_EQ(folder_.findings("camera.set = \"list\""),
            "r.toml: camera.positions must hold a position with camera.set = \"list\"");
  EXPECT_EQ(folder_.findings("camera.set = \"list\"\ncamera.positions = []"),
            "r.toml:5:20: camera.positions must hold a position with camera.set = \"list\"");
  EXPECT_EQ(folder_.findings("camera.set = \"list\"\ncamera.positions = [[1, 2], [1, 2, nan]]"),
            "r.toml:5:21: camera.positions must be a list of lists of three numbers in [-1000000, "
            "1000000], got [1, 2]");
  EXPECT_EQ(folder_.findings("camera.set = \"list\"\ncamera.positions = [[0, 0, 0]]"),
            "r.toml: camera.target must not be where a camera stands, got view 0 there");
  EXPECT_EQ(
      folder_.findings(
          "camera.set = \"list\"\ncamera.positions = [[1, 0, 0]]\ncamera.target = [2, 0, 0]\n"
          "camera.lens_radius_m = 0.01"),
      "r.toml: camera.focus must be in front of every camera, got -1 m for view 0; \"target\" "
      "always is");
  EXPECT_EQ(folder_.findings("camera.focus = \"distance\""),
            "r.toml: camera.focus_distance_m must be given with camera.focus = \"distance\"");
  EXPECT_EQ(folder_.findings("camera.set = \"dodecahedron\"\ncamera.count = 3"),
            "r.toml:4:14: camera.set must be \"half-dodecahedron\" or \"list\" or \"orbit\" or "
            "\"hemisphere\" or \"random\", got "
            "\"dodecahedron\"");
}

TEST(CameraTypes, AreReadFromTheirTable) {
  const RecipeFolder folder;
  EXPECT_EQ(folder.read("").cameras[0].type, 0);
  for (std::size_t i = 0; i < camera_types().size(); ++i) {
    const CameraType& type = camera_types()[i];
    const std::string lines = fmt::format("camera.type = \"{}\"\n", type.name);
    const Camera camera = folder.read(lines).cameras[0];
    EXPECT_EQ(camera.type, static_cast<int>(i));
    EXPECT_EQ(span_of(camera), std::stod(std::string(type.host.default_value)));
    const std::string key = fmt::format("camera.{}", type.span_name());
    EXPECT_EQ(span_of(folder.read(lines + key + " = 0.5\n").cameras[0]), 0.5);
    EXPECT_THAT(folder.findings(lines + key + " = 0\n"), testing::HasSubstr(key + " must be"));
    if (type.host.span != kernels::CameraSpan::extent_m) continue;
    EXPECT_THAT(folder.findings(lines + "camera.fov_deg = 50\n"),
                testing::HasSubstr("camera.fov_deg has no effect"));
    EXPECT_THAT(folder.findings(lines + key + " = 0.5\ncamera.distance_m = \"fit\"\n"),
                testing::HasSubstr(key + " must not be given with camera.distance_m = \"fit\""));
    EXPECT_TRUE(folder.read(lines + "camera.distance_m = \"fit\"\n").camera_fit);
  }
}

}  // namespace
}  // namespace ds
