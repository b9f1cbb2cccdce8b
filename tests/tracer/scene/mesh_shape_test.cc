// SPDX-License-Identifier: Apache-2.0
// Copies of the demo's models, and of the benchmark's where they are to be had, are found, and no two different
// models are.
#include "tracer/scene/mesh_shape.h"

#include "mesh_samples.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// What check.leaks_near_shape is without being given.
constexpr double k_near = 0.03;
/// A step of what is stored.
constexpr double k_step = 1.01e-4;

/// In [-1, 1), of a number.
double noise(std::uint64_t number) {
  std::uint64_t z = (number + 1) * 0x9e3779b97f4a7c15U;  // splitmix64
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-52 - 1;
}

/// Turned about an axis that is none of the coordinates', mirrored or not, scaled and moved far away.
FileMesh moved(FileMesh mesh, double angle, bool mirror, double scale) {
  const Vec3d axis = normalized(Vec3d{1, 2, -0.5});
  const double c = std::cos(angle), s = std::sin(angle);
  for (Vec3d& p : mesh.positions) {
    if (mirror) p.x = -p.x;
    p = p * c + cross(axis, p) * s + axis * (dot(axis, p) * (1 - c));
    p = p * scale + Vec3d{3, -2, 1} * scale;
  }
  return mesh;
}

/// Each triangle in four, in another order, with vertices that nothing shares.
FileMesh remeshed(const FileMesh& mesh) {
  FileMesh to;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[mesh.triangles.size() - 1 - i];
    const Vec3d a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    const Vec3d ab = (a + b) * 0.5, bc = a * 0.0 + (b * 2 + c) * (1.0 / 3), ca = (c * 4 + a) * 0.2;
    for (const auto& [p, q, r] : {std::array{a, ab, ca}, std::array{ab, b, bc},
                                  std::array{ca, bc, c}, std::array{ab, bc, ca}}) {
      const auto at = static_cast<std::uint32_t>(to.positions.size());
      to.positions.insert(to.positions.end(), {p, q, r});
      to.triangles.push_back({at, at + 1, at + 2});
    }
  }
  return to;
}

double size_of(const FileMesh& mesh) {
  const Box box = bounds_of(mesh);
  return length(box.most - box.least);
}

/// Each vertex moved by up to a share of the model's size.
FileMesh noisy(FileMesh mesh, double share) {
  const double most = share * size_of(mesh);
  std::uint64_t number = 0;
  for (Vec3d& p : mesh.positions) {
    const Vec3d by{noise(number), noise(number + 1), noise(number + 2)};
    number += 3;
    p = p + by * most;
  }
  return mesh;
}

struct Named {
  std::string name;
  FileMesh mesh;
  std::string shape;
};

std::vector<Named> models_in(const fs::path& folder) {
  std::vector<Named> models;
  if (!fs::is_directory(folder)) return models;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".ply" && entry.path().extension() != ".off") continue;
    FileMesh mesh = read_model(entry.path()).mesh;
    std::string shape = shape_of(mesh);
    models.push_back({entry.path().filename().string(), std::move(mesh), std::move(shape)});
  }
  return models;
}

void expect_different(const std::vector<Named>& models) {
  double least = std::numeric_limits<double>::infinity();
  std::string pair;
  for (std::size_t i = 0; i < models.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = shape_distance(models[i].shape, models[j].shape);
      EXPECT_GT(distance, k_near) << models[i].name << " " << models[j].name;
      if (distance >= least) continue;
      least = distance;
      pair = models[i].name + " " + models[j].name;
    }
  std::cout << models.size() << " models, nearest " << least << " " << pair << "\n";
}

TEST(MeshShape, FindsCopiesOfTheDemosModelsAndNothingElse) {
  const std::vector<Named> models = models_in(DS_SOURCE_DIR "/assets/models");
  ASSERT_GE(models.size(), 32U);
  std::size_t number = 0;
  for (const auto& [name, mesh, shape] : models) {
    const auto distance = [&, &of = shape](const FileMesh& copy) {
      return shape_distance(of, shape_of(copy));
    };
    EXPECT_LE(distance(moved(mesh, 1, false, 1000)), k_step) << name;
    EXPECT_LE(distance(moved(mesh, 2, true, 1e-3)), k_step) << name;
    EXPECT_LE(distance(noisy(mesh, 0.0003)), k_near) << name;
    // Four times the triangles, for time's sake of every fourth.
    if (number++ % 4 == 0) {
      EXPECT_LE(distance(remeshed(moved(mesh, 3, true, 2))), k_step) << name;
    }
  }
  expect_different(models);
}

TEST(MeshShape, TellsTheBenchmarksModelsApart) {
  const std::vector<Named> models = models_in(DS_SOURCE_DIR "/../shared/data/psb/models");
  if (models.empty()) GTEST_SKIP() << "they are not here";
  std::size_t found = 0;
  for (const auto& [name, mesh, shape] : models) {
    EXPECT_LE(shape_distance(shape, shape_of(moved(mesh, 1, true, 7))), k_step) << name;
    EXPECT_LE(shape_distance(shape, shape_of(remeshed(mesh))), k_step) << name;
    found += shape_distance(shape, shape_of(noisy(mesh, 0.001))) <= k_near ? 1U : 0U;
  }
  std::cout << found << " noisy copies found\n";
  EXPECT_GE(found, models.size() * 3 / 4);
  expect_different(models);
}

// Of a square of side 1 about the origin: the mean of x^2 is 1 / 12, of the square of r 1 / 6.
TEST(MeshShape, IsWhatIsIntegrated) {
  FileMesh square;
  square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::string shape = shape_of(square);
  ASSERT_EQ(shape.size(), 76U);
  const auto number = [&](std::size_t i) {
    return std::stoi(shape.substr(4 * i, 4), nullptr, 16) * 1e-4;
  };
  EXPECT_NEAR(number(0), std::sqrt(0.5), 1e-4);
  EXPECT_NEAR(number(1), std::sqrt(0.5), 1e-4);
  EXPECT_EQ(number(2), 0);
  // r^2 x^2 = x^4 + x^2 y^2: 1 / 80 + 1 / 144.
  EXPECT_NEAR(number(3), std::pow(1.0 / 80 + 1.0 / 144, 0.25) * std::sqrt(6), 1e-4);
  // r^4 x^2 = x^6 + 2 x^4 y^2 + x^2 y^4: 1 / 448 + 3 / (80 * 12).
  EXPECT_NEAR(number(6), std::pow(1.0 / 448 + 3.0 / 960, 1.0 / 6) * std::sqrt(6), 1e-4);
  for (const std::size_t i : {9U, 10U, 11U, 12U, 13U, 14U, 15U, 17U, 18U})
    EXPECT_EQ(number(i), 0) << i;  // symmetric, and in a plane through its centre
  EXPECT_NEAR(number(16), 1, 1e-4);
}

TEST(MeshShape, OfNoAreaIsNone) {
  FileMesh line;
  EXPECT_EQ(shape_of(line), "");
  line.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.triangles = {{0, 1, 2}};
  EXPECT_EQ(shape_of(line), "");
  EXPECT_EQ(shape_distance("", ""), std::numeric_limits<double>::infinity());
  EXPECT_EQ(shape_distance(std::string(76, 'x'), std::string(76, '0')),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace ds
