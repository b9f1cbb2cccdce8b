// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_outward.h"

#include "tests/tracer/scene/mesh_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace ds {
namespace {

using samples::Triangles;

FileMesh box(Vec3d low, Vec3d high) {
  FileMesh mesh;
  for (const double z : {low.z, high.z})
    for (const double y : {low.y, high.y})
      for (const double x : {low.x, high.x})
        mesh.positions.push_back({x, y, z});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

FileMesh cube(Vec3d centre, double half) {
  const Vec3d h{half, half, half};
  return box(centre - h, centre + h);
}

FileMesh reversed(FileMesh mesh) {
  for (auto& t : mesh.triangles)
    std::swap(t[1], t[2]);
  return mesh;
}

FileMesh operator+(FileMesh a, const FileMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const auto& t : b.triangles)
    a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

double volume(const FileMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += dot(mesh.positions[a], cross(mesh.positions[b], mesh.positions[c])) / 6;
  return sum;
}

WindingReport turn(FileMesh& mesh) {
  return turn_outwards(mesh.positions, weld(mesh.positions), mesh.triangles);
}

/// Turned, each face is as in `right`, wherever its corners begin.
void expect_becomes(FileMesh mesh, const FileMesh& right, std::uint64_t turned) {
  const WindingReport report = turn(mesh);
  EXPECT_EQ(report.turned, turned);
  EXPECT_EQ(report.against, 0U);
  const auto from_least = [](Triangles list) {
    for (auto& t : list)
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return list;
  };
  EXPECT_EQ(from_least(mesh.triangles), from_least(right.triangles));
}

TEST(TurnOutwards, AClosedBodyWhicheverWayItRuns) {
  for (const Vec3d at : {Vec3d{}, Vec3d{412345.678, 5678901.234, -87.5}, Vec3d{1e9, -1e9, 1e9}}) {
    const FileMesh right = box(at, at + Vec3d{1.1, 0.8, 2.6});
    EXPECT_GT(volume(box({}, {1, 1, 1})), 0);
    expect_becomes(right, right, 0);
    expect_becomes(reversed(right), right, 12);
  }
}

TEST(TurnOutwards, APartOfABodyInAnyShare) {
  const FileMesh right = cube({5, 6, 7}, 1);
  for (unsigned set = 0; set < 1U << 12U; set += 7) {
    FileMesh mesh = right;
    std::uint64_t wrong = 0;
    for (std::size_t i = 0; i < 12; ++i)
      if ((set >> i & 1U) != 0) {
        std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
        ++wrong;
      }
    expect_becomes(mesh, right, wrong);
  }
}

TEST(TurnOutwards, CornersWrittenOnceAFaceAreOneSurface) {
  FileMesh loose;
  const FileMesh right = cube({}, 1);
  for (const auto& t : right.triangles) {
    const auto first = static_cast<std::uint32_t>(loose.positions.size());
    for (const std::uint32_t v : t)
      loose.positions.push_back(right.positions[v]);
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  expect_becomes(reversed(loose), loose, 12);
}

/// As scripts write them: the last ring of the turn and the poles are computed anew, by sines that
/// are 1e-16 and not 0.
FileMesh sphere_with_seams(int rings, int sectors) {
  constexpr double k_pi = std::numbers::pi;
  FileMesh mesh;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j <= sectors; ++j) {
      const double polar = k_pi * i / rings, azimuth = 2 * k_pi * j / sectors;
      mesh.positions.push_back({std::sin(polar) * std::cos(azimuth),
                                std::sin(polar) * std::sin(azimuth), std::cos(polar)});
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (sectors + 1) + j); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      if (i > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  return mesh;
}

TEST(TurnOutwards, SeamsThatDifferInTheLastDigitsAreClosed) {
  const int rings = 12, sectors = 24;
  const FileMesh right = sphere_with_seams(rings, sectors);
  EXPECT_GT(volume(right), 4);  // 4 pi / 3, less what facets cut off
  for (const bool in_part : {false, true}) {
    FileMesh mesh = right;
    for (std::size_t t = 0; t < mesh.triangles.size(); t += in_part ? 3 : 1)
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    const WindingReport report = turn(mesh);
    EXPECT_EQ(report.against, 0U);
    EXPECT_NEAR(volume(mesh), volume(right), 1e-12);
    // The south pole's second triangles have a side of 1e-16; which way they run nobody sees.
    EXPECT_GE(report.turned, in_part ? 160U : 504U);
  }
  // What is open stays as it is: the same without a strip from pole to pole.
  FileMesh open = reversed(right);
  std::erase_if(open.triangles,
                [&](const auto& t) { return t[0] % static_cast<unsigned>(sectors + 1) == 5; });
  const FileMesh before = open;
  EXPECT_EQ(turn(open).turned, 0U);
  EXPECT_EQ(open.triangles, before.triangles);
}

TEST(TurnOutwards, ThinBodiesAreNotWeldedShut) {
  // A plate thinner than the grid that seams are welded on, and two sheets as near.
  const FileMesh plate = box({0, 0, 0}, {1, 1, 1e-8});
  expect_becomes(reversed(plate), plate, 12);
  FileMesh sheets = box({0, 0, 0}, {1, 1, 1e-8});
  sheets.triangles.resize(4);
  const auto before = sheets.triangles;
  EXPECT_EQ(turn(sheets).turned, 0U);
  EXPECT_EQ(sheets.triangles, before);
}

TEST(TurnOutwards, EachOfSeveralBodies) {
  const FileMesh a = cube({}, 1), b = cube({5, 0, 0}, 1), c = cube({0, 5, 0}, 0.1);
  expect_becomes(reversed(a) + b + reversed(c), a + b + c, 24);
  // Two that share an edge: four triangles meet there, two of each.
  const FileMesh d = cube({2, 2, 0}, 1);
  expect_becomes(reversed(a) + d, a + d, 12);
  // Two that share a corner, and two that cross.
  expect_becomes(a + reversed(cube({2, 2, 2}, 1)), a + cube({2, 2, 2}, 1), 12);
  expect_becomes(reversed(a) + cube({1, 0.3, 0.2}, 1), a + cube({1, 0.3, 0.2}, 1), 12);
}

TEST(TurnOutwards, AHollowStaysHollow) {
  const FileMesh outer = cube({1, 2, 3}, 1), hole = reversed(cube({1.1, 2.2, 3.1}, 0.5));
  expect_becomes(outer + hole, outer + hole, 0);
  expect_becomes(hole + outer, hole + outer, 0);
  // Inside out as a whole: the same solid.
  expect_becomes(reversed(outer + hole), outer + hole, 24);
  // A body in it that is wound as its surroundings is another body.
  const FileMesh body = cube({1.1, 2.2, 3.1}, 0.5), pearl = cube({1.1, 2.2, 3.1}, 0.1);
  expect_becomes(outer + body, outer + body, 0);
  expect_becomes(reversed(outer + body), outer + body, 24);
  expect_becomes(outer + hole + pearl, outer + hole + pearl, 0);
  expect_becomes(reversed(pearl + outer + hole), pearl + outer + hole, 36);
}

TEST(TurnOutwards, NothingIsInsideWhatItOnlyStandsBeside) {
  // Within the bounds of an L, but in its empty corner.
  const FileMesh tower = box({0, 0, 0}, {1, 1, 4}) + box({1, 0, 0}, {4, 1, 1});
  FileMesh ell;  // one closed surface of the same outline
  ell.positions = {{0, 0, 0}, {4, 0, 0}, {4, 0, 1}, {1, 0, 1}, {1, 0, 4}, {0, 0, 4},
                   {0, 1, 0}, {4, 1, 0}, {4, 1, 1}, {1, 1, 1}, {1, 1, 4}, {0, 1, 4}};
  ell.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4},  {0, 4, 5},
                   {6, 8, 7}, {6, 9, 8}, {6, 10, 9}, {6, 11, 10}};
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t j = (i + 1) % 6;
    ell.triangles.push_back({j, i, i + 6});
    ell.triangles.push_back({j, i + 6, j + 6});
  }
  ASSERT_NEAR(volume(ell), volume(tower), 1e-12);
  const FileMesh beside = cube({2, 0.5, 2}, 0.25), within = cube({2, 0.5, 0.5}, 0.25);
  expect_becomes(ell + reversed(beside), ell + beside, 12);
  expect_becomes(ell + reversed(within), ell + reversed(within), 0);
}

TEST(TurnOutwards, OpenSurfacesStayAndAreCounted) {
  FileMesh open = cube({}, 1);
  open.triangles.pop_back();
  std::swap(open.triangles[3][1], open.triangles[3][2]);
  FileMesh mesh = reversed(open);
  EXPECT_EQ(turn(mesh).turned, 0U);
  EXPECT_EQ(mesh.triangles, reversed(open).triangles);
  EXPECT_EQ(turn(mesh).against, 1U);
  // Flat, and so without an inside: two triangles over a square, two of the other diagonal under it.
  FileMesh pillow;
  pillow.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  pillow.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  mesh = reversed(pillow);
  EXPECT_EQ(turn(mesh).turned, 0U);
  // A closed body beside them is mended all the same.
  mesh = open + reversed(cube({9, 0, 0}, 1)) + pillow;
  const WindingReport report = turn(mesh);
  EXPECT_EQ(report.turned, 12U);
  EXPECT_EQ(report.against, 1U);
}

TEST(TurnOutwards, AMoebiusBandAndAKleinBottleEnd) {
  for (const bool closed : {false, true}) {
    constexpr std::uint32_t k_around = 9, k_across = 5;
    FileMesh mesh;
    std::mt19937 random(1);
    const std::uint32_t rows = closed ? k_across : k_across + 1;
    for (std::uint32_t i = 0; i < k_around * rows; ++i)
      mesh.positions.push_back({double(random() % 1000), double(random() % 1000), double(i)});
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
      if (i == k_around) {
        i = 0;
        j = closed ? (k_across - j % k_across) % k_across : k_across - j;
      }
      return i * rows + (closed ? j % k_across : j);
    };
    for (std::uint32_t i = 0; i < k_around; ++i)
      for (std::uint32_t j = 0; j < k_across; ++j) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
      }
    const FileMesh before = mesh;
    const WindingReport report = turn(mesh);
    EXPECT_EQ(mesh.triangles, before.triangles);
    EXPECT_EQ(report.turned, 0U);
    EXPECT_LE(report.against, mesh.triangles.size() / 2);
  }
}

TEST(TurnOutwards, TrianglesWithoutAreaJoinWhatMeetsInAT) {
  // The edge from (-1,-1,-1) to (1,-1,-1) is whole below and halved in front, and a triangle of its
  // three places stands between.
  const std::string file =
      "OFF\n9 14 0\n-1 -1 -1\n1 -1 -1\n-1 1 -1\n1 1 -1\n-1 -1 1\n1 -1 1\n-1 1 1\n1 1 1\n0 -1 -1\n"
      "3 0 2 3\n3 0 3 1\n3 4 5 7\n3 4 7 6\n3 0 8 4\n3 8 1 5\n3 8 5 4\n3 0 1 8\n3 2 6 7\n3 2 7 3\n"
      "3 0 4 6\n3 0 6 2\n3 1 3 7\n3 1 7 5\n";
  const Model right = parse_model(file, "m");
  EXPECT_EQ(right.report.zero_area, 1U);
  EXPECT_EQ(right.report.flipped, 0U);
  EXPECT_NEAR(volume(right.mesh), 8, 1e-12);
  std::string inwards = file;
  for (std::size_t at = 0; (at = inwards.find("\n3 ", at)) != inwards.npos; ++at) {
    const std::size_t b = at + 5, c = at + 7;
    std::swap(inwards[b], inwards[c]);
  }
  const Model turned = parse_model(inwards, "m");
  EXPECT_EQ(turned.report.flipped, 13U);
  EXPECT_NEAR(volume(turned.mesh), 8, 1e-12);
}

TEST(TurnOutwards, ThousandsInsideAnotherAreSoonTold) {
  // One wound outwards around 16,000 of both windings: those wound inwards are hollows in it.
  FileMesh mesh = cube({}, 100);
  for (int i = 0; i < 16000; ++i) {
    const FileMesh one =
        cube({-90.0 + i % 25 * 7, -90.0 + i / 25 % 25 * 7, -90.0 + i / 625 * 7}, 1);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), one.positions.begin(), one.positions.end());
    for (const auto& t : one.triangles)
      mesh.triangles.push_back(i % 2 == 0 ? Triangle{t[0] + first, t[1] + first, t[2] + first}
                                          : Triangle{t[0] + first, t[2] + first, t[1] + first});
  }
  FileMesh inwards = reversed(mesh);
  EXPECT_EQ(turn(mesh).turned, 0U);
  EXPECT_EQ(turn(inwards).turned, 12U * 16001);
}

TEST(Mend, TellsWhatItTurned) {
  const Model model = parse_model(
      "OFF 4 4 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n3 0 1 2\n3 0 3 1\n3 0 2 3\n3 1 3 2\n", "m");
  EXPECT_EQ(model.report.flipped, 4U);
  EXPECT_EQ(to_text(mended_damage(model.report)),
            "triangles of closed surfaces turned to face outwards: 4");
  EXPECT_NEAR(volume(model.mesh), 64.0 / 6, 1e-12);
}

}  // namespace
}  // namespace ds
