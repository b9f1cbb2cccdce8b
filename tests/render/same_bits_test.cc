// SPDX-License-Identifier: Apache-2.0
// A strict picture has the same bits whatever runs it and however: the sum of all effects, a
// picture at a time.
#include "tests/render/pictures.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <set>

namespace ds {
namespace {

using pictures::Picture;

void expect_same_bits(const std::function<void(TracerOptions&)>& change) {
  for (const Picture& picture : pictures::all_effects()) {
    TracerOptions options = pictures::tracer_options();
    const std::string usual = pictures::film_hash(pictures::trace(picture, options));
    change(options);
    EXPECT_EQ(pictures::film_hash(pictures::trace(picture, options)), usual) << picture.name;
  }
}

class Lanes : public testing::TestWithParam<int> {};
TEST_P(Lanes, DoNotChangeABit) {
  expect_same_bits([](TracerOptions& o) { o.lanes = GetParam(); });
}
TEST_P(Lanes, DoNotChangeABitOfTheFullProgram) {
  expect_same_bits([](TracerOptions& o) {
    o.lanes = GetParam();
    o.full_program = true;
  });
}
INSTANTIATE_TEST_SUITE_P(SameBits, Lanes, testing::Values(1, 4, 8, 16));

class WorkGroups : public testing::TestWithParam<int> {};
TEST_P(WorkGroups, DoNotChangeABit) {
  expect_same_bits([](TracerOptions& o) { o.work_group_size = GetParam(); });
}
INSTANTIATE_TEST_SUITE_P(SameBits, WorkGroups, testing::Values(1, 3, 64));

class ItemPixels : public testing::TestWithParam<int> {};
TEST_P(ItemPixels, DoNotChangeABit) {
  for (const int lanes : {1, 16})
    expect_same_bits([&](TracerOptions& o) {
      o.lanes = lanes;
      o.item_pixels = GetParam();
    });
}
// Less than a tile and no divisor of one, more than a tile, more than a picture.
INSTANTIATE_TEST_SUITE_P(SameBits, ItemPixels, testing::Values(5, 80, 100000));

TEST(SameBits, BvhQualityDoesNotChangeABit) {
  expect_same_bits([](TracerOptions& o) { o.high_quality_bvh = true; });
}

class BvhWidths : public testing::TestWithParam<int> {};
TEST_P(BvhWidths, DoNotChangeABit) {
  expect_same_bits([](TracerOptions& o) { o.bvh_width = GetParam(); });
}
INSTANTIATE_TEST_SUITE_P(SameBits, BvhWidths, testing::Values(2, 4));

/// What picture_bits prints with this many threads.
std::string bits_in_child(int threads) {
  const std::string command = "POCL_MAX_PTHREAD_COUNT=" + std::to_string(threads) +
                              " '" DS_PICTURE_BITS "' --picture everything 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return "cannot start";
  std::string out;
  std::array<char, 256> part{};
  while (std::fgets(part.data(), static_cast<int>(part.size()), pipe) != nullptr)
    out += part.data();
  EXPECT_EQ(::pclose(pipe), 0) << out;
  return out;
}

TEST(SameBits, ThreadsDoNotChangeABit) {
  const std::string usual = pictures::film_hash(pictures::trace(pictures::all_effects().back()));
  for (const int threads : {1, 2, 3})
    EXPECT_NE(bits_in_child(threads).find("everything film " + usual + "\n"), std::string::npos)
        << threads << " threads";
}

TEST(SameBits, AScenesBitsDoNotDependOnTheOneBefore) {
  const std::vector<Picture> all = pictures::all_effects();
  Tracer tracer(pictures::tracer_options());
  for (const std::size_t i : {0u, 1u, 0u, 2u, 1u}) {
    tracer.set_scene(all[i].scene);
    EXPECT_EQ(pictures::film_hash(tracer.trace(all[i].camera, all[i].engine)),
              pictures::film_hash(pictures::trace(all[i])))
        << all[i].name;
  }
}

TEST(SameBits, PicturesShowWhatTheyClaim) {
  // A picture of nothing would pass everything above.
  for (const Picture& picture : pictures::all_effects()) {
    const Film film = pictures::trace(picture);
    EXPECT_EQ(film.rejected_samples, 0u) << picture.name;
    const std::set<float> values(film.rgb.begin(), film.rgb.end());
    EXPECT_GT(values.size(), film.rgb.size() / 4) << picture.name;
    Tracer tracer(pictures::tracer_options());
    tracer.set_scene(picture.scene);
    const Geometry geometry =
        tracer.trace_geometry(picture.camera, picture.engine.width, picture.engine.height);
    EXPECT_GT(
        std::count_if(geometry.depth.begin(), geometry.depth.end(), [](float d) { return d > 0; }),
        300);
  }
  std::set<int> materials, textures, lights;
  for (const Picture& picture : pictures::all_effects()) {
    for (const Object& object : picture.scene.objects)
      materials.insert(picture.scene.materials[static_cast<std::size_t>(object.material)].type);
    for (const Texture& texture : picture.scene.textures)
      textures.insert(texture.type);
    for (const Light& light : picture.scene.lights)
      lights.insert(light.type);
  }
  EXPECT_EQ(materials.size(), material_types().size());
  EXPECT_EQ(textures.size(), texture_types().size());
  EXPECT_EQ(lights.size() + 1, light_types().size());  // and an object that emits
}

}  // namespace
}  // namespace ds
