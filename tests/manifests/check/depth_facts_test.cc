// SPDX-License-Identifier: Apache-2.0
// Balls, whose depths are known in closed form, seen by two cameras.
#include "manifests/check/depth_facts.h"

#include "manifests/camera_geometry.h"
#include "manifests/check/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace ds {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int k_width = 96, k_height = 72;
constexpr double k_radius = 0.08;
const Vec3d k_middle{0.02, -0.01, 0.03};

/// Of a unit ball in its file, turned about z and scaled.
ModelPose ball_pose() {
  const double c = 0.6 * k_radius, s = 0.8 * k_radius;
  return {{c, -s, 0, k_middle.x, s, c, 0, k_middle.y, 0, 0, k_radius, k_middle.z, 0, 0, 0, 1},
          {{-1, -1, -1}, {1, 1, 1}}};
}

ImageRecord record_from(Vec3d position, bool parallel) {
  Camera camera;
  camera.position = position;
  camera.target = {0, 0, 0};
  ImageRecord record;
  record.id = record.model = "ball";
  record.width = k_width;
  record.height = k_height;
  record.camera_to_world = camera_pose(camera);
  if (parallel)
    record.metres_per_pixel = 0.3 / k_width;
  else
    record.intrinsics = camera_intrinsics(40, k_width, k_height);
  record.pose = ball_pose();
  return record;
}

/// What a ray meets first of a ball: along it, in its own length.
std::optional<double> meets(Vec3d origin, Vec3d way, Vec3d middle, double radius) {
  const Vec3d from = origin - middle;
  const double a = dot(way, way), b = dot(from, way), c = dot(from, from) - radius * radius;
  const double root = b * b - a * c;
  if (root < 0) return std::nullopt;
  return (-b - std::sqrt(root)) / a;
}

/// The ball before a wall of depth 0.9, and where `hidden`, another ball a third of the way before it.
DepthView view_of(const ImageRecord& record, bool hidden = false) {
  DepthView view{&record, {}, {}};
  const auto& m = record.camera_to_world;
  const Vec3d right{m[0], m[4], m[8]}, down{m[1], m[5], m[9]}, forward{m[2], m[6], m[10]},
      at{m[3], m[7], m[11]};
  for (int y = 0; y < k_height; ++y)
    for (int x = 0; x < k_width; ++x) {
      Vec3d origin = at, way = forward;
      if (record.intrinsics) {
        const auto& k = *record.intrinsics;
        way = forward + right * ((x + 0.5 - k[2]) / k[0]) + down * ((y + 0.5 - k[5]) / k[4]);
      } else {
        origin = at + right * ((x + 0.5 - k_width / 2.0) * *record.metres_per_pixel) +
                 down * ((y + 0.5 - k_height / 2.0) * *record.metres_per_pixel);
      }
      const auto ball = meets(origin, way, k_middle, k_radius);
      const auto other =
          hidden ? meets(origin, way, k_middle * 0.7 + at * 0.3, 0.02) : std::nullopt;
      view.depth.push_back(static_cast<float>(other ? *other : ball.value_or(0.9)));
      view.mask.push_back(ball && !other ? 1 : 0);
    }
  return view;
}

class Depths : public testing::TestWithParam<bool> {
 protected:
  ImageRecord front_ = record_from({0.4, 0.05, 0.2}, GetParam()),
              side_ = record_from({0.25, 0.35, 0.1}, GetParam());
};

TEST_P(Depths, OfTwoViewsOfABallAgree) {
  const DepthView front = view_of(front_), side = view_of(side_), hidden = view_of(side_, true);
  for (const DepthView* other : {&side, &hidden}) {
    const DepthFacts facts = depth_facts(front, other);
    EXPECT_GT(facts.shown, 500U);
    EXPECT_EQ(facts.elsewhere, 0U);
    EXPECT_GT(facts.compared, 300U);
    EXPECT_EQ(facts.missed, 0U);
  }
  EXPECT_EQ(depth_facts(front, nullptr).compared, 0U);
  for (int y = 0; y < k_height; y += 7)
    for (int x = 0; x < k_width; x += 5) {
      const Vec3d pixel = pixel_of(side_, point_at(side_, x, y, 0.37));
      EXPECT_NEAR(pixel.x, x + 0.5, 1e-9);
      EXPECT_NEAR(pixel.y, y + 0.5, 1e-9);
      EXPECT_NEAR(pixel.z, 0.37, 1e-12);
    }
}

// Each fault alone, by the least part of the pixels that tell of it.
TEST_P(Depths, WhatIsWrongIsFound) {
  const DepthView front = view_of(front_), side = view_of(side_);
  const auto part = [](std::uint64_t some, std::uint64_t all) {
    return static_cast<double>(some) / static_cast<double>(all);
  };
  const auto changed = [&](const std::function<void(DepthView&)>& change) {
    DepthView view = front;
    change(view);
    const DepthFacts facts = depth_facts(view, &side);
    return std::max(part(facts.elsewhere, facts.shown),
                    facts.compared == 0 ? 0 : part(facts.missed, facts.compared));
  };
  EXPECT_EQ(changed([](DepthView&) {}), 0);
  // Too near, in another unit, none at all. What is too far by less than the model is deep, is hidden.
  for (const float factor : {0.95F, 0.8F, 1.5F, 1000.0F, 0.0F})
    EXPECT_GT(changed([&](DepthView& view) {
                for (float& depth : view.depth)
                  depth *= factor;
              }),
              0.05)
        << factor;
  // The depths, and the mask, of another view.
  EXPECT_GT(changed([&](DepthView& view) { view.depth = view_of(side_).depth; }), 0.05);
  // Upside down.
  EXPECT_GT(changed([&](DepthView& view) { std::reverse(view.mask.begin(), view.mask.end()); }),
            0.05);
  // A camera of OpenGL's axes, one that stands elsewhere, a model that does.
  for (int fault = 0; fault < 3; ++fault) {
    ImageRecord wrong = front_;
    if (fault == 0)
      for (const std::size_t i : {1U, 2U, 5U, 6U, 9U, 10U})
        wrong.camera_to_world[i] *= -1;
    if (fault == 1) wrong.camera_to_world = side_.camera_to_world;
    if (fault == 2) wrong.pose->model_to_world[7] += 0.05;
    EXPECT_GT(changed([&](DepthView& view) { view.record = &wrong; }), 0.05) << fault;
  }
}

/// A disc that has no thickness, before the wall.
DepthView view_of_disc(const ImageRecord& record, Vec3d normal) {
  DepthView view{&record, {}, {}};
  const Vec3d at{record.camera_to_world[3], record.camera_to_world[7], record.camera_to_world[11]};
  for (int y = 0; y < k_height; ++y)
    for (int x = 0; x < k_width; ++x) {
      // Two points of a ray tell it, of both cameras.
      const Vec3d origin = record.intrinsics ? at : point_at(record, x, y, 0);
      const Vec3d way = point_at(record, x, y, 1) - origin;
      const double depth = dot(k_middle - origin, normal) / dot(way, normal);
      const Vec3d off = origin + way * depth - k_middle;
      const bool met = depth > 0 && dot(off, off) < k_radius * k_radius;
      view.depth.push_back(static_cast<float>(met ? depth : 0.9));
      view.mask.push_back(met ? 1 : 0);
    }
  return view;
}

// Seen from its edge it is a sixth of a pixel wide, and nearly all pixels' middles pass it by.
TEST_P(Depths, OfWhatIsThinAreNotMissedFromItsEdge) {
  const auto way_to = [](const ImageRecord& record) {
    const auto& m = record.camera_to_world;
    return GetParam() ? normalized(Vec3d{-m[2], -m[6], -m[10]})
                      : normalized(Vec3d{m[3], m[7], m[11]} - k_middle);
  };
  const Vec3d front = way_to(front_), side = way_to(side_);
  const Vec3d edge_on = normalized(front - side * dot(front, side)) + side * 0.004;
  const DepthView own = view_of_disc(front_, edge_on);
  const DepthView edge = view_of_disc(side_, edge_on);
  const DepthFacts facts = depth_facts(own, &edge);
  EXPECT_GT(facts.shown, 200U);
  EXPECT_EQ(facts.elsewhere, 0U);
  EXPECT_EQ(facts.missed, 0U) << facts.compared;
  // Where the other sees its face it tells, and what is wrong is found.
  const Vec3d between = normalized(front + side);
  DepthView face = view_of_disc(front_, between);
  const DepthView other = view_of_disc(side_, between);
  const DepthFacts good = depth_facts(face, &other);
  EXPECT_GT(good.compared, 500U);
  EXPECT_EQ(good.missed, 0U);
  for (float& depth : face.depth)
    depth *= 0.9F;
  const DepthFacts bad = depth_facts(face, &other);
  EXPECT_GT(bad.missed * 20, bad.compared) << bad.missed;
}

INSTANTIATE_TEST_SUITE_P(OfBothCameras, Depths, testing::Bool());

/// One image, seen as that view has it.
CheckInput input_of(const ImageRecord& record) {
  CheckInput input;
  input.images = {record};
  const DepthView view = view_of(record);
  DepthFacts facts = depth_facts(view, nullptr);
  input.files.pictures.emplace_back();
  input.files.depths.emplace_back(facts);
  std::uint64_t left = k_width, right = k_width, above = k_height, below = k_height;
  for (std::uint64_t y = 0; y < k_height; ++y)
    for (std::uint64_t x = 0; x < k_width; ++x)
      if (view.mask[y * k_width + x] != 0) {
        left = std::min(left, x);
        right = std::min(right, k_width - 1 - x);
        above = std::min(above, y);
        below = std::min(below, k_height - 1 - y);
      }
  PixelCounts& counts = input.images[0].pixel_counts;
  counts.model = facts.shown;
  counts.left = left;
  counts.right = right;
  counts.above = above;
  counts.below = below;
  return input;
}

TEST(PosesCheck, AMaskIsWhereItsPoseSays) {
  for (const bool parallel : {false, true}) {
    CheckInput input = input_of(record_from({0.4, 0.05, 0.2}, parallel));
    EXPECT_THAT(run_checks(input, {"poses", "depths"}), IsEmpty());
    input.images[0].pose->model_to_world[7] += 0.05;
    auto found = run_checks(input, {"poses"});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].level, CheckLevel::error);
    EXPECT_THAT(found[0].what, HasSubstr("outside of the box that its pose"));
    EXPECT_THAT(found[0].images, ElementsAre("ball"));
    input.files.depths[0]->elsewhere = input.files.depths[0]->shown / 10;
    found = run_checks(input, {"depths"});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_THAT(found[0].what, HasSubstr("depths where their model is not"));
    // The recipe says how much may be.
    input.recipe_now = "check.depths_elsewhere = 0.5\n";
    EXPECT_THAT(run_checks(input, {"depths"}), IsEmpty());
  }
}

}  // namespace
}  // namespace ds
