// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/ties.h"

#include "tests/render/pictures.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/sdl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace ds {
namespace {

using kernels::k_flag_covered;
using kernels::k_flag_covers;
using kernels::k_flag_tie_rounded;
using kernels::k_tie_rank_shift;

Ties ties_of(const Scene& scene, int width = k_most_bvh_width) {
  std::vector<std::array<Vec3, 3>> corners;
  for (const Object& object : scene.objects)
    for (const auto& t : object.mesh.triangles)
      corners.push_back(
          {object.mesh.positions[t[0]], object.mesh.positions[t[1]], object.mesh.positions[t[2]]});
  return find_ties(scene, corners, build_bvh(corners, BvhQuality::medium, width));
}

/// By object of two triangles each: the flags of the first, less rank and error.
std::vector<std::uint32_t> kinds(const Ties& ties) {
  std::vector<std::uint32_t> list;
  for (std::size_t i = 0; i < ties.flags.size(); i += 2)
    list.push_back((ties.flags[i] | ties.flags[i + 1]) & 0xffu);
  return list;
}

Mesh level_square(float x, float z, float half) {
  return pictures::quad({x, 0, z}, {half, 0, 0}, {0, half, 0});
}

Scene scene_of(const std::vector<Mesh>& meshes) {
  Scene scene;
  const int grey = pictures::add_matte(scene, {0.5f, 0.5f, 0.5f});
  for (const Mesh& mesh : meshes)
    pictures::add_object(scene, mesh, grey);
  return scene;
}

TEST(Ties, AreOfFacesInOnePlaneThatOverlap) {
  const Ties ties = ties_of(scene_of({level_square(0, 0.3f, 1), level_square(0.5f, 0.3f, 0.25f)}));
  EXPECT_EQ(kinds(ties), (std::vector<std::uint32_t>{k_flag_covered, k_flag_covers}));
  ASSERT_EQ(ties.places.size(), 1u);
  const TiePlace& place = ties.places[0];
  EXPECT_LT(place.low[0], 0.25f);
  EXPECT_GT(place.low[0], 0.2f);
  EXPECT_LE(place.low[2], 0.3f);
  EXPECT_GE(place.high[2], 0.3f);
}

TEST(Ties, AreNotOfNeighboursNorOfFacesThatRaysCanTellApart) {
  for (const Mesh& other : {level_square(1.5f, 0.3f, 0.5f), level_square(0.5f, 0.30001f, 0.25f),
                            level_square(3, 0.3f, 0.5f),
                            pictures::quad({0.5f, 0, 0.3f}, {0.25f, 0, 0.02f}, {0, 0.25f, 0}),
                            pictures::quad({0.5f, 0, 0.3f}, {0.25f, 0, 0}, {0, 0, 0.25f})}) {
    const Ties ties = ties_of(scene_of({level_square(0, 0.3f, 1), other}));
    EXPECT_EQ(kinds(ties), (std::vector<std::uint32_t>{0, 0}));
    EXPECT_TRUE(ties.places.empty());
  }
}

TEST(TiePlaces, HoldAllThatWasAddedInFewBoxes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  for (const double spread : {0.5, 5.0, 50.0}) {
    TiePlaces places;
    std::vector<std::pair<Vec3d, Vec3d>> added;
    for (int i = 0; i < 200; ++i) {
      const Vec3d low{spread * u(random), spread * u(random), spread * u(random)};
      added.emplace_back(low, low + Vec3d{u(random), u(random), 0});
      places.add({added.back().first, added.back().second});
    }
    const std::vector<TiePlace> boxes = places.take();
    EXPECT_LE(boxes.size(), std::size_t{k_most_tie_places});
    for (const auto& [low, high] : added)
      EXPECT_TRUE(
          std::any_of(boxes.begin(), boxes.end(), [&, l = low, h = high](const TiePlace& b) {
            return double{b.low[0]} <= l.x && double{b.low[1]} <= l.y && double{b.low[2]} <= l.z &&
                   double{b.high[0]} >= h.x && double{b.high[1]} >= h.y && double{b.high[2]} >= h.z;
          }));
  }
}

TEST(TiePlaces, StayApartWhereThereAreFew) {
  TiePlaces places;
  for (int i = 0; i < k_most_tie_places; ++i)
    places.add({{3.0 * i, 0, 0}, {3.0 * i + 1, 1, 0}});
  EXPECT_EQ(places.take().size(), std::size_t{k_most_tie_places});
  places.add({{0.5, 0.5, 0}, {2, 2, 0}});  // meets the first
  const std::vector<TiePlace> boxes = places.take();
  EXPECT_EQ(boxes.size(), std::size_t{k_most_tie_places});
  EXPECT_EQ(boxes.back().high[0], 2);
}

/// Each of them nearly fills its leaf's box, and both come near others' boxes.
TEST(Ties, DoNotDependOnTheTree) {
  std::vector<Mesh> meshes;
  for (int i = 0; i < 12; ++i)
    meshes.push_back(
        level_square(0.3f * static_cast<float>(i), 0.3f + 1e-7f * static_cast<float>(i), 0.4f));
  const Scene scene = scene_of(meshes);
  const Ties usual = ties_of(scene);
  for (const int width : {2, 3, 5}) {
    const Ties other = ties_of(scene, width);
    EXPECT_EQ(other.flags, usual.flags) << width;
    EXPECT_EQ(other.places, usual.places) << width;
  }
}

TEST(Ties, OfOneObjectAreNone) {
  const Scene scene = scene_of({level_square(0, 0, 1)});
  EXPECT_EQ(kinds(ties_of(scene)), std::vector<std::uint32_t>{0});
}

TEST(Ties, AreMarkedWhereNotInTheSamePlaneAcrossAnAxis) {
  const Mesh tilted = pictures::quad({0, 0, 0.3f}, {1, 0, 0.3f}, {0, 1, 0.1f});
  const Mesh part = pictures::quad({0.1f, 0, 0.33f}, {0.1f, 0, 0.03f}, {0, 0.1f, 0.01f});
  const Ties ties = ties_of(scene_of({tilted, part}));
  EXPECT_EQ(kinds(ties), (std::vector<std::uint32_t>{k_flag_covered | k_flag_tie_rounded,
                                                     k_flag_covers | k_flag_tie_rounded}));
}

TEST(Ties, RankModelsBeforeLampsBeforeLesserThingsBeforeEarlierOnes) {
  Scene scene = scene_of({level_square(0, 0, 1), level_square(0, 0, 0.5f), level_square(0, 0, 0.5f),
                          level_square(0, 0, 2), level_square(0, 0, 3)});
  const int lamp = pictures::add_matte(scene, {});
  scene.materials[static_cast<std::size_t>(lamp)].emits = true;
  scene.materials[static_cast<std::size_t>(lamp)].emission.constant = {1, 1, 1};
  scene.objects[3].material = lamp;
  scene.objects[4].id = k_model_object_id;
  const Ties ties = ties_of(scene);
  std::vector<std::uint32_t> ranks;
  for (std::size_t i = 0; i < ties.flags.size(); i += 2)
    ranks.push_back(ties.flags[i] >> k_tie_rank_shift);
  EXPECT_EQ(ranks, (std::vector<std::uint32_t>{4, 2, 3, 1, 0}));
}

}  // namespace
}  // namespace ds
