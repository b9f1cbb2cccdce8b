// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/mesh_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace ds {
namespace {

using samples::box_off;
using samples::replaced;

constexpr NormaliseOptions k_as_it_is{
    .up = UpAxis::z, .size_m = 0, .place_on_ground = false, .centre = Centring::none};

FileMesh model(const std::string& file) {
  return parse_model(file, "m").mesh;
}

template <typename Position>
struct Bounds {
  Position least, most;
};
template <typename Position>
Bounds<Position> bounds(const BasicMesh<Position>& mesh) {
  Bounds<Position> b{mesh.positions[0], mesh.positions[0]};
  for (const Position p : mesh.positions) {
    b.least = {std::min(b.least.x, p.x), std::min(b.least.y, p.y), std::min(b.least.z, p.z)};
    b.most = {std::max(b.most.x, p.x), std::max(b.most.y, p.y), std::max(b.most.z, p.z)};
  }
  return b;
}
void expect_near(Vec3 a, Vec3 b, double tolerance) {
  EXPECT_LE(length(to_double(a) - to_double(b)), tolerance)
      << fmt::format("({}, {}, {}) and ({}, {}, {})", a.x, a.y, a.z, b.x, b.y, b.z);
}
// Half a unit in the last place of 0.16.
constexpr double k_rounding = 1e-8;

TEST(Normalise, PlacesABoxAsTheThesisDoes) {
  // 2 wide, 4 high (Y up), 1 deep: the height becomes z.
  const Mesh mesh = normalise(model(box_off(2, 4, 1)), {});
  const Bounds<Vec3> b = bounds(mesh);
  expect_near(b.least, {-0.04F, -0.02F, -0.0574F}, k_rounding);
  expect_near(b.most, {0.04F, 0.02F, 0.16F - 0.0574F}, k_rounding);
  EXPECT_EQ(b.least.z, -0.0574F);
}

TEST(Normalise, TurnsYUpToZUpWithoutMirroring) {
  NormaliseOptions options = k_as_it_is;
  options.up = UpAxis::y;
  options.normals = Normals::flat;
  const Mesh mesh = normalise(model("OFF 3 1 0\n1 2 3\n2 2 3\n1 3 3\n3 0 1 2\n"), options);
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{1, -3, 2}, {2, -3, 2}, {1, -3, 3}}));
  EXPECT_EQ(mesh.normals, std::vector<Vec3>(3, {0, -1, 0}));  // +Z turned
}

TEST(Normalise, EachStepCanBeSwitchedOff) {
  const FileMesh source = model(replaced(samples::k_tetra_off, "0 0 0", "-1 0.5 2"));
  const Mesh same = normalise(source, k_as_it_is);
  EXPECT_EQ(to_double(bounds(same).least), bounds(source).least);
  EXPECT_EQ(to_double(bounds(same).most), bounds(source).most);

  NormaliseOptions only_size = k_as_it_is;
  only_size.size_m = 10;
  const Bounds<Vec3> scaled = bounds(normalise(source, only_size));
  expect_near(scaled.least, {-2, 0, 0}, 1e-6);
  expect_near(scaled.most, {8, 8, 8}, 1e-6);

  NormaliseOptions only_ground = k_as_it_is;
  only_ground.place_on_ground = true;
  only_ground.ground_z_m = 7;
  EXPECT_EQ(bounds(normalise(source, only_ground)).least, (Vec3{-1, 0, 7}));

  NormaliseOptions only_box = k_as_it_is;
  only_box.centre = Centring::box;
  EXPECT_EQ(bounds(normalise(source, only_box)).least, (Vec3{-2.5F, -2, 0}));
}

TEST(Normalise, CentreOfMassIsThatOfTheSurface) {
  // The tetrahedron (0,0,0) (4,0,0) (0,4,0) (0,0,4): three right triangles of area 8 with centroids
  // (4/3, 4/3, 0) and permutations, and one of 8 sqrt 3 with centroid (4/3, 4/3, 4/3). In x and y:
  // (2 * 8 + 8 sqrt 3) * 4/3 / (24 + 8 sqrt 3), whatever its tessellation or duplicates.
  const double centre = (16 + 8 * std::numbers::sqrt3) * 4 / 3 / (24 + 8 * std::numbers::sqrt3);
  NormaliseOptions options = k_as_it_is;
  options.centre = Centring::mass;
  const Bounds<Vec3> b = bounds(normalise(model(samples::k_tetra_off), options));
  expect_near(b.least, {static_cast<float>(-centre), static_cast<float>(-centre), 0}, 2e-7);
}

TEST(Normalise, AFarModelKeepsItsDigits) {
  // Moved by 2^20 in file units, where floats step by 1/16: the box's corners are still exact.
  std::string far = "OFF\n8 6 0\n";
  for (const char* corner :
       {"0 0 0", "2 0 0", "2 4 0", "0 4 0", "0 0 1", "2 0 1", "2 4 1", "0 4 1"}) {
    int x = 0, y = 0, z = 0;
    ASSERT_EQ(std::sscanf(corner, "%d %d %d", &x, &y, &z), 3);
    far += fmt::format("{} {} {}\n", x + 1048576, y - 1048576, z + 1048576);
  }
  far += "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
  const Mesh near_mesh = normalise(model(box_off(2, 4, 1)), {}),
             far_mesh = normalise(model(far), {});
  ASSERT_EQ(near_mesh.positions.size(), far_mesh.positions.size());
  for (std::size_t i = 0; i < near_mesh.positions.size(); ++i)
    expect_near(near_mesh.positions[i], far_mesh.positions[i], 1e-9);
}

/// Two boxes, 1.1 x 0.8 x 2.6 m, moved: as binary PLY of doubles, and as texts of all digits.
std::vector<std::string> figures(Vec3d by) {
  std::vector<Vec3d> vertices;
  for (const auto& [low, high] : {std::pair{Vec3d{0, 0, 0}, Vec3d{1.1, 0.8, 0.4}},
                                  {Vec3d{0.05, 0.1, 0.4}, Vec3d{0.35, 0.6, 2.6}}})
    for (const double x : {low.x, high.x})
      for (const double y : {low.y, high.y})
        for (const double z : {low.z, high.z})
          vertices.push_back(Vec3d{x, y, z} + by);
  const int quads[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                           {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 16\nproperty double x\n"
      "property double y\nproperty double z\nelement face 12\n"
      "property list uchar int vertex_indices\nend_header\n";
  std::string off = "OFF\n16 12 0\n", text;
  for (const Vec3d v : vertices) {
    text += fmt::format("{:.17g} {:.17g} {:.17g}\n", v.x, v.y, v.z);
    for (const double x : {v.x, v.y, v.z})
      samples::put<double>(binary, x, std::endian::little);
  }
  for (int box = 0; box < 2; ++box)
    for (const auto& quad : quads) {
      text += "4";
      samples::put<std::uint8_t>(binary, 4, std::endian::little);
      for (const int corner : quad) {
        text += fmt::format(" {}", corner + 8 * box);
        samples::put<std::int32_t>(binary, corner + 8 * box, std::endian::little);
      }
      text += "\n";
    }
  return {binary, off + text,
          "ply\nformat ascii 1.0\nelement vertex 16\nproperty float x\nproperty float y\n"
          "property float z\nelement face 12\nproperty list uchar int vertex_indices\n"
          "end_header\n" +
              text};
}

TEST(Normalise, ASurveysCoordinatesAreTakenOffInDouble) {
  // Where floats step by 0.5 m. Doubles step by 1e-9 m and less, of 2.6 m that become 0.16.
  for (const Centring centre : {Centring::mass, Centring::box})
    for (const Normals normals : {Normals::smooth, Normals::flat}) {
      NormaliseOptions options;
      options.up = UpAxis::z;
      options.centre = centre;
      options.normals = normals;
      const Mesh right = normalise(model(figures({})[0]), options);
      for (const Vec3d by : {Vec3d{412345.678, 5678901.234, 87.5}, Vec3d{-5678901.234, 0, 0}})
        for (const std::string& file : figures(by)) {
          const Mesh mesh = normalise(model(file), options);
          ASSERT_EQ(mesh.positions.size(), right.positions.size());
          for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            expect_near(mesh.positions[i], right.positions[i], 2e-8);
            expect_near(mesh.normals[i], right.normals[i], 1e-7);
          }
        }
    }
}

TEST(Normalise, AMeshOfAnyScaleKeepsItsDigits) {
  // Coordinates that no float holds at all: too small ones become 0, and the body a point.
  std::string tiny =
      "OFF\n4 4 0\n0 0 0\n4e-60 0 0\n0 4e-60 0\n0 0 4e-60\n"
      "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const Mesh right = normalise(model(samples::k_tetra_off), {}), mesh = normalise(model(tiny), {});
  ASSERT_EQ(mesh.positions.size(), right.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    expect_near(mesh.positions[i], right.positions[i], 1e-8);
}

TEST(Normalise, WhereFloatsCannotHoldAModelItIsAnError) {
  // Left at its survey's coordinates, or put on a ground too far away for its size.
  NormaliseOptions options = k_as_it_is;
  try {
    normalise(model(figures({412345.678, 5678901.234, 87.5})[1]), options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::asset);
    EXPECT_THAT(error.what(), testing::HasSubstr("5.6789e+06 m from the world's origin"));
    EXPECT_THAT(error.what(), testing::HasSubstr("models.centre"));
  }
  options = {};
  options.ground_z_m = 1e6;
  EXPECT_THROW(normalise(model(samples::k_tetra_off), options), Error);
  options.size_m = 1e3;
  EXPECT_NO_THROW(normalise(model(samples::k_tetra_off), options));
}

TEST(Normalise, ACubeSplitsIntoTwentyFourVertices) {
  for (const Normals normals : {Normals::smooth, Normals::flat}) {
    NormaliseOptions options = k_as_it_is;
    options.normals = normals;
    const Mesh mesh = normalise(model(box_off(1, 1, 1)), options);
    EXPECT_EQ(mesh.positions.size(), 24U);
    EXPECT_EQ(mesh.triangles.size(), 12U);
    std::set<std::tuple<float, float, float>> directions;
    for (const Vec3 n : mesh.normals)
      directions.insert({n.x, n.y, n.z});
    EXPECT_EQ(directions,
              (std::set<std::tuple<float, float, float>>{
                  {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}));
  }
  NormaliseOptions round = k_as_it_is;
  round.crease_deg = 91;
  EXPECT_EQ(normalise(model(box_off(1, 1, 1)), round).positions.size(), 8U);
}

/// A sphere of radius 1 about (5, 6, 7) as rows of quads, every quad with vertices of its own, as
/// many benchmark models are written.
std::string sphere_off(int rows, int columns) {
  std::string vertices, faces;
  int count = 0, face_count = 0;
  const auto at = [&](int row, int column) {
    const double theta = std::numbers::pi * row / rows;
    const double phi = 2 * std::numbers::pi * (column % columns) / columns;
    const double ring = row == 0 || row == rows ? 0 : std::sin(theta);
    return fmt::format("{:.9g} {:.9g} {:.9g}\n", 5 + ring * std::cos(phi), 6 + ring * std::sin(phi),
                       7 + std::cos(theta));
  };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      vertices += at(r, c) + at(r + 1, c) + at(r + 1, c + 1) + at(r, c + 1);
      faces += fmt::format("4 {} {} {} {}\n", count, count + 1, count + 2, count + 3);
      count += 4;
      ++face_count;
    }
  return fmt::format("OFF\n{} {} 0\n", count, face_count) + vertices + faces;
}

double worst_angle_deg(const Mesh& mesh, Vec3d centre) {
  double worst = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3d radial = normalized(to_double(mesh.positions[i]) - centre);
    const Vec3d normal = to_double(mesh.normals[i]);
    worst = std::max(worst, std::atan2(length(cross(radial, normal)), dot(radial, normal)));
  }
  return worst * 180 / std::numbers::pi;
}

TEST(Normalise, ASphereOfLooseQuadsIsSmooth) {
  const Model loose = parse_model(sphere_off(64, 128), "m");
  EXPECT_EQ(loose.report.zero_area, 2U * 128);  // a quad at a pole has an edge of length 0
  EXPECT_EQ(loose.report.flipped, 0U);
  const Mesh mesh = normalise(loose.mesh, k_as_it_is);
  EXPECT_EQ(mesh.positions.size(), 63U * 128 + 2);
  // A row spans 2.8 degrees; the quads' diagonals tilt the mean by a small part of that.
  EXPECT_LT(worst_angle_deg(mesh, {5, 6, 7}), 0.1);
}

TEST(Normalise, FlippedTrianglesDoNotSpoilTheirNeighbours) {
  Model loose = parse_model(sphere_off(64, 128), "m");
  auto& triangles = loose.mesh.triangles;
  for (std::size_t i = 0; i < triangles.size(); i += 37)
    std::swap(triangles[i][1], triangles[i][2]);
  const Mesh mesh = normalise(loose.mesh, k_as_it_is);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) {
      const Vec3d radial = normalized(to_double(mesh.positions[v]) - Vec3d{5, 6, 7});
      const double cosine = dot(radial, to_double(mesh.normals[v])) * (t % 37 == 0 ? -1 : 1);
      EXPECT_GT(cosine, 0.999) << t;  // 2.6 degrees: about the size of a triangle
    }
}

const char* const k_with_normals =
    "STNOFF 4 2 0\n0 0 0 0 0 1 0 0\n1 0 0 0 1 0 1 0\n1 1 0 0 0 1 1 1\n0 1 0 3 0 4 0 1\n3 0 1 2\n3 "
    "0 2 3\n";

TEST(Normalise, KeepTurnsTheStoredNormals) {
  NormaliseOptions options = k_as_it_is;
  options.up = UpAxis::y;
  options.normals = Normals::keep;
  const FileMesh source = model(k_with_normals);
  const Mesh mesh = normalise(source, options);
  EXPECT_EQ(mesh.normals, (std::vector<Vec3>{{0, -1, 0}, {0, 0, 1}, {0, -1, 0}, {0.6F, -0.8F, 0}}));
  EXPECT_EQ(mesh.triangles, source.triangles);
  EXPECT_EQ(mesh.uvs, source.uvs);
}

TEST(Normalise, KeepWantsNormals) {
  NormaliseOptions options;
  options.normals = Normals::keep;
  const FileMesh mesh = model(samples::k_tetra_off);
  EXPECT_THROW(normalise(mesh, options), Error);
}

TEST(Normalise, KeepsUvsAndSplitsWhereTheyDiffer) {
  const Mesh one = normalise(model(k_with_normals), k_as_it_is);
  EXPECT_EQ(one.positions.size(), 4U);
  EXPECT_EQ(one.uvs, (std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
  // A seam: the same square with vertices of its own for the second triangle, one with another uv.
  const Mesh seam =
      normalise(model("STOFF 6 2 0\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 0 0 0.5 0\n1 1 0 1 1\n"
                      "0 1 0 0 1\n3 0 1 2\n3 3 4 5\n"),
                k_as_it_is);
  EXPECT_EQ(seam.positions.size(), 5U);
  EXPECT_EQ(seam.normals, std::vector<Vec3>(5, {0, 0, 1}));
}

TEST(Normalise, HasNoNegativeZeroAndIsPure) {
  const FileMesh source = model(samples::k_tetra_off);
  for (const Normals normals : {Normals::smooth, Normals::flat}) {
    NormaliseOptions options;
    options.normals = normals;
    const Mesh mesh = normalise(source, options);
    EXPECT_EQ(geometry_hash(mesh), geometry_hash(normalise(source, options)));
    for (const auto& list : {mesh.positions, mesh.normals})
      for (const Vec3 v : list)
        for (const float x : {v.x, v.y, v.z})
          EXPECT_FALSE(x == 0 && std::signbit(x));
  }
}

/// A bumpy sheet of whole-number coordinates: nothing in the file depends on a mathematical
/// library.
std::string sheet_off() {
  constexpr int k_side = 20;
  std::string vertices, faces;
  for (int y = 0; y <= k_side; ++y)
    for (int x = 0; x <= k_side; ++x)
      vertices += fmt::format("{} {} {}\n", 3 * x, (7 * x * y + 5 * x * x) % 6, 3 * y);
  for (int y = 0; y < k_side; ++y)
    for (int x = 0; x < k_side; ++x) {
      const int at = y * (k_side + 1) + x;
      faces += fmt::format("4 {} {} {} {}\n", at, at + k_side + 1, at + k_side + 2, at + 1);
    }
  return fmt::format("OFF\n{} {} 0\n", (k_side + 1) * (k_side + 1), k_side * k_side) + vertices +
         faces;
}

TEST(Normalise, GivesTheSameBitsOnEveryMachine) {
  // The value a first run gave. Another one makes every dataset stale: then raise the host's render
  // version with it.
  EXPECT_EQ(geometry_hash(normalise(model(sheet_off()), {})).hex(),
            "850b24596518aeda843e0e9407d265bd");
}

void expect_near(Vec3d a, Vec3d b) {
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(a[axis], b[axis], 1e-5 * (1 + std::abs(a[axis])));
}

Vec3d moved(const Mat4& matrix, Vec3d p) {
  const auto& m = matrix.m;
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
          m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}

TEST(NormalisedBox, IsTheBoxOfTheNormalisedMesh) {
  const FileMesh source = model(sheet_off());
  NormaliseOptions options;
  for (const UpAxis up : {UpAxis::y, UpAxis::z})
    for (const double size_m : {0.0, 0.16, 160.0})
      for (const bool on_ground : {false, true}) {
        options.up = up;
        options.size_m = size_m;
        options.place_on_ground = on_ground;
        for (const Centring centre : {Centring::none, Centring::box, Centring::mass}) {
          options.centre = centre;
          const Box box = normalised_box(extent_of(source), options);
          const Mesh mesh = normalise(source, options);
          const Box placed = bounds_of(mesh);
          expect_near(box.least, placed.least);
          expect_near(box.most, placed.most);
          const Mat4 matrix = model_to_world(extent_of(source), options);
          for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            for (std::size_t c = 0; c < 3; ++c)
              expect_near(moved(matrix, source.positions[source.triangles[t][c]]),
                          to_double(mesh.positions[mesh.triangles[t][c]]));
        }
      }
}

TEST(ModelToWorld, IsWhatTheRecipeSays) {
  // A box of 2 x 4 x 1 with its least corner at (10, 20, 30), y up; two of its faces weigh more.
  const MeshExtent file{{{10, 20, 30}, {12, 24, 31}}, {11, 21, 30.5}};
  NormaliseOptions options;
  options.size_m = 8;  // twice as large
  options.ground_z_m = 0.5;
  const Mat4 matrix = model_to_world(file, options);
  // x stays, y becomes z, z becomes -y; the centroid is at x = y = 0, the least y on the ground.
  EXPECT_EQ(moved(matrix, {11, 20, 30.5}), (Vec3d{0, 0, 0.5}));
  EXPECT_EQ(moved(matrix, {12, 24, 31}), (Vec3d{2, -1, 8.5}));
  EXPECT_EQ(moved(matrix, {10, 20, 30}), (Vec3d{-2, 1, 0.5}));
  EXPECT_EQ(normalised_box(file, options), (Box{{-2, -1, 0.5}, {2, 1, 8.5}}));
}

constexpr double k_half = 0.70710678118654752;

TEST(Normalise, TurnsTheModelAndPutsItOnTheGround) {
  // 2 wide, 4 high, 1 deep, its least corner at the origin. A quarter about x lays it on its back: the
  // height, which chose the size, becomes -y.
  const FileMesh source = model(box_off(2, 4, 1));
  NormaliseOptions options;
  options.size_m = 4;
  options.ground_z_m = 0.5;
  options.centre = Centring::box;
  options.turn = {k_half, k_half, 0, 0};
  options.place_m = {10, 20, 0.25};
  EXPECT_TRUE(turns(options) && tilts(options));
  const Bounds<Vec3> lying = bounds(normalise(source, options));
  expect_near(lying.least, {9, 18, 0.75F}, 2e-6);
  expect_near(lying.most, {11, 22, 1.75F}, 2e-6);
  // A quarter about the vertical swaps width and depth.
  options.turn = {k_half, 0, 0, k_half};
  EXPECT_TRUE(turns(options) && !tilts(options));
  const Bounds<Vec3> standing = bounds(normalise(source, options));
  expect_near(standing.least, {9.5F, 19, 0.75F}, 2e-6);
  expect_near(standing.most, {10.5F, 21, 4.75F}, 2e-6);
  // Where the file's height stays, it turns about its middle at height 0.
  options.place_on_ground = false;
  options.turn = {k_half, k_half, 0, 0};
  const Bounds<Vec3> left = bounds(normalise(source, options));
  expect_near(left.least, {9, 16, -0.25F}, 2e-6);
  expect_near(left.most, {11, 20, 0.75F}, 2e-6);
}

TEST(ModelToWorld, IsWhatNormaliseDoesToATurnedMesh) {
  const FileMesh source = model(sheet_off());
  NormaliseOptions options;
  for (const bool on_ground : {false, true})
    for (const std::array<double, 4>& turn :
         {std::array<double, 4>{0.5, 0.5, -0.5, 0.5}, {0.8, 0, 0, -0.6}, {0.1, 0.7, -0.1, 0.7}})
      for (const Centring centre : {Centring::none, Centring::box, Centring::mass}) {
        options.place_on_ground = on_ground;
        options.turn = turn;
        options.centre = centre;
        options.place_m = {0.5, -0.25, 1};
        const Mesh mesh = normalise(source, options);
        const double lowest = lowest_of(source, options);
        const Mat4 matrix = model_to_world(extent_of(source), options, lowest);
        const Box around = normalised_box(extent_of(source), options, lowest);
        Vec3d least{9, 9, 9};
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
          for (std::size_t c = 0; c < 3; ++c) {
            const Vec3d place = to_double(mesh.positions[mesh.triangles[t][c]]);
            expect_near(moved(matrix, source.positions[source.triangles[t][c]]), place);
            for (int axis = 0; axis < 3; ++axis) {
              EXPECT_GE(place[axis], around.least[axis] - 1e-6);
              EXPECT_LE(place[axis], around.most[axis] + 1e-6);
            }
            least.z = std::min(least.z, place.z);
          }
        if (on_ground) {
          EXPECT_NEAR(least.z, options.ground_z_m + 1, 1e-7);
        }
        // The size is that of the upright mesh: lengths stay.
        NormaliseOptions still = options;
        still.turn = NormaliseOptions{}.turn;
        const Mesh upright = normalise(source, still);
        const auto side = [](const Mesh& m) {
          return length(to_double(m.positions[m.triangles[0][0]]) -
                        to_double(m.positions[m.triangles[0][1]]));
        };
        EXPECT_NEAR(side(mesh), side(upright), 1e-7);
      }
}

TEST(Normalise, NormalsTurnWithTheModel) {
  const FileMesh source = model(box_off(2, 4, 1));
  for (const Normals normals : {Normals::smooth, Normals::flat}) {
    NormaliseOptions options;
    options.normals = normals;
    const Mesh before = normalise(source, options);
    options.turn = {k_half, 0, 0, k_half};
    const Mesh after = normalise(source, options);
    ASSERT_EQ(before.normals.size(), after.normals.size());
    for (std::size_t i = 0; i < before.normals.size(); ++i) {
      const Vec3 n = before.normals[i];
      expect_near(after.normals[i], {-n.y, n.x, n.z}, 1e-6);
    }
  }
}

}  // namespace
}  // namespace ds
