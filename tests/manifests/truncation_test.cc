// SPDX-License-Identifier: Apache-2.0
#include "manifests/truncation.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ds {
namespace {

constexpr int k_width = 40, k_height = 20;

/// A camera at the origin that looks along the world's x axis; at a distance of 1 a pixel is 1/40 wide.
ImageRecord seen_by_pinhole() {
  ImageRecord image;
  image.width = k_width;
  image.height = k_height;
  image.intrinsics = {40, 0, 20, 0, 40, 10, 0, 0, 1};
  // Columns: right = -y, down = -z, forward = x.
  image.camera_to_world = {0, 0, 1, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 1};
  return image;
}

/// A rectangle at distance x, from y0 to y1 and z0 to z1, in the world.
FileMesh rectangle(double x, double y0, double y1, double z0, double z1) {
  FileMesh mesh;
  mesh.positions = {{x, y0, z0}, {x, y1, z0}, {x, y1, z1}, {x, y0, z1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Box box_around(const FileMesh& mesh) {
  Box box{mesh.positions[0], mesh.positions[0]};
  for (const Vec3d p : mesh.positions) {
    box.least = {std::min(box.least.x, p.x), std::min(box.least.y, p.y),
                 std::min(box.least.z, p.z)};
    box.most = {std::max(box.most.x, p.x), std::max(box.most.y, p.y), std::max(box.most.z, p.z)};
  }
  return box;
}

struct Counted {
  std::optional<PixelCounts> counts;
  bool read = false;
};

Counted counts_of(ImageRecord image, const FileMesh& mesh) {
  image.pose = ModelPose{{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, box_around(mesh)};
  Counted counted;
  counted.counts = count_beyond(image, [&]() -> const FileMesh& {
    counted.read = true;
    return mesh;
  });
  return counted;
}

TEST(Truncation, AModelInsideIsNotRead) {
  const Counted counted = counts_of(seen_by_pinhole(), rectangle(1, -0.5, 0.5, -0.25, 0.25));
  EXPECT_FALSE(counted.read);
  EXPECT_EQ(counted.counts->beyond, 0U);
  EXPECT_FALSE(counted.counts->whole);
}

TEST(Truncation, CountsWhatIsBeyondEachSide) {
  struct Case {
    double y0, y1, z0, z1;
    std::uint64_t beyond, whole;
  };
  const Case cases[] = {
      {-1, 0, -0.25, 0.25, 20 * 20, 40 * 20},      // half of it beyond the right
      {0.25, 0.75, -0.1, 0.1, 10 * 8, 20 * 8},     // beyond the left
      {-0.1, 0.1, 0, 0.75, 8 * 20, 8 * 30},        // above
      {-0.1, 0.1, -0.75, 0, 8 * 20, 8 * 30},       // below
      {-1, 1, -0.5, 0.5, 80 * 40 - 800, 80 * 40},  // all round
      {2, 3, -0.1, 0.1, 40 * 8, 40 * 8},           // all of it beyond
  };
  for (const Case& c : cases) {
    const Counted counted = counts_of(seen_by_pinhole(), rectangle(1, c.y0, c.y1, c.z0, c.z1));
    EXPECT_TRUE(counted.read);
    EXPECT_EQ(counted.counts->beyond, c.beyond) << c.y0;
    EXPECT_EQ(counted.counts->whole, c.whole) << c.y0;
  }
}

TEST(Truncation, FacesBehindEachOtherCountOnce) {
  FileMesh mesh = rectangle(1, -1, 0, -0.25, 0.25);
  const FileMesh behind = rectangle(2, -2, 0, -0.5, 0.5);  // covers the same
  for (const Vec3d p : behind.positions)
    mesh.positions.push_back(p);
  mesh.triangles.push_back({4, 5, 6});
  mesh.triangles.push_back({4, 6, 7});
  const Counted counted = counts_of(seen_by_pinhole(), mesh);
  EXPECT_EQ(counted.counts->beyond, 400U);
  EXPECT_EQ(counted.counts->whole, 800U);
}

TEST(Truncation, ParallelRays) {
  ImageRecord image = seen_by_pinhole();
  image.intrinsics.reset();
  image.metres_per_pixel = 0.025;
  const Counted counted = counts_of(image, rectangle(7, -1, 0, -0.25, 0.25));
  EXPECT_EQ(counted.counts->beyond, 400U);
  EXPECT_EQ(counted.counts->whole, 800U);
}

TEST(Truncation, HasNoEndBesideTheCamera) {
  FileMesh mesh = rectangle(1, -1, 0, -0.25, 0.25);
  mesh.positions[0].x = -1;
  const Counted counted = counts_of(seen_by_pinhole(), mesh);
  EXPECT_EQ(counted.counts->beyond, 0U);
  EXPECT_EQ(counted.counts->whole, 0U);
}

TEST(Truncation, FarLargerThanThePicture) {
  // 80,000 pixels wide and high, of which 800 are in the picture: every 20th of every 20th row is looked at.
  const Counted counted = counts_of(seen_by_pinhole(), rectangle(0.001, -1, 1, -1, 1));
  const double whole = 80000.0 * 80000.0;
  EXPECT_NEAR(static_cast<double>(*counted.counts->whole), whole, 1e-3 * whole);
  EXPECT_NEAR(static_cast<double>(*counted.counts->whole - *counted.counts->beyond), 800, 400);
}

TEST(Truncation, LineSaysWhatFollows) {
  ImageRecord image = seen_by_pinhole();
  const auto line_of = [&](std::optional<std::uint64_t> beyond,
                           std::optional<std::uint64_t> whole) {
    image.pixel_counts.beyond = beyond;
    image.pixel_counts.whole = whole;
    return to_json_line(image);
  };
  EXPECT_EQ(line_of({}, {}).find("truncation"), std::string::npos);
  EXPECT_NE(line_of(0, {}).find(R"("truncation":0.0)"), std::string::npos);
  EXPECT_NE(line_of(0, 0).find(R"("truncation":null)"), std::string::npos);
  EXPECT_NE(line_of(1, 4).find(R"("truncation":0.25)"), std::string::npos);
}

}  // namespace
}  // namespace ds
