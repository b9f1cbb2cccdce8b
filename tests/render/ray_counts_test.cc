// SPDX-License-Identifier: Apache-2.0
// Work that cannot matter is not done: the rays of small pictures, counted. Each count is known
// from the scene alone.
#include "tests/render/pictures.h"
#include "tracer/device/program_text.h"

#include <gtest/gtest.h>

namespace ds {
namespace {

constexpr int k_width = 24, k_height = 16, k_spp = 4;
constexpr std::uint64_t k_samples = std::uint64_t{k_width} * k_height * k_spp;

/// Looks straight down on the origin from 1 m above; sees 2 tan(25 deg) = 0.93 m across.
Camera from_above() {
  Camera camera;
  camera.position = {0, 0, 1};
  camera.up = {0, 1, 0};
  camera.fov_deg = 50;
  return camera;
}

EngineSettings small_engine() {
  EngineSettings engine;
  engine.width = k_width;
  engine.height = k_height;
  engine.spp = k_spp;
  engine.seed = 11;
  return engine;
}

struct Counted {
  RayCounts rays;
  Film film;

  double sum() const {
    double sum = 0;
    for (const float v : film.rgb)
      sum += double{v};
    return sum;
  }
};

Counted count(const Scene& scene, bool full_program = false,
              const EngineSettings& engine = small_engine(), const Camera& camera = from_above()) {
  TracerOptions options = pictures::tracer_options();
  options.count_rays = true;
  options.full_program = full_program;
  Tracer tracer(options);
  tracer.set_scene(scene);
  Counted counted;
  counted.film = tracer.trace(camera, engine);
  counted.rays = tracer.ray_counts();
  return counted;
}

/// A floor that fills the picture.
Scene floor_of(Vec3 kd) {
  Scene scene;
  pictures::add_object(scene, pictures::quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}),
                       pictures::add_matte(scene, kd));
  return scene;
}

/// In the specialised and in the full program.
class Rays : public testing::TestWithParam<bool> {};

TEST_P(Rays, AMatteFloorUnderAPointCostsOneShadowRayASample) {
  Scene scene = floor_of({0.5f, 0.5f, 0.5f});
  scene.lights.push_back(pictures::point_light({0, 0, 2}, {1, 1, 1}));
  const Counted c = count(scene, GetParam());
  EXPECT_EQ(c.rays.camera, k_samples);
  EXPECT_EQ(c.rays.shadow, k_samples);
  EXPECT_GT(c.sum(), 0);
}

TEST_P(Rays, ASpotThatShinesElsewhereCostsNoShadowRay) {
  Scene scene = floor_of({0.5f, 0.5f, 0.5f});
  scene.lights.push_back(pictures::spot_light({0, 0, 1.5f}, {1, 0, 0.5f}, 30, 20, {9, 9, 9}));
  const Counted c = count(scene, GetParam());
  EXPECT_EQ(c.rays.shadow, 0U);
  EXPECT_EQ(c.sum(), 0);
  // Turned to the floor it costs as many as points of it are lit.
  scene.lights[0] = pictures::spot_light({0, 0, 1.5f}, {0, 0, -1}, 5, 4, {9, 9, 9});
  const Counted lit = count(scene, GetParam());
  EXPECT_GT(lit.rays.shadow, 0U);
  EXPECT_LT(lit.rays.shadow, k_samples / 4);
}

TEST_P(Rays, LightsBelowTheHorizonCostNoShadowRay) {
  Scene point = floor_of({0.5f, 0.5f, 0.5f});
  point.lights.push_back(pictures::point_light({0, 0, -1}, {1, 1, 1}));
  Scene sun = floor_of({0.5f, 0.5f, 0.5f});
  sun.lights.push_back(pictures::sun_light({0.3f, 0, -1}, 1, {100, 100, 100}));
  Scene emitter = floor_of({0.5f, 0.5f, 0.5f});
  const int lamp = pictures::add_matte(emitter, {0, 0, 0});
  emitter.materials.back().emits = true;
  emitter.materials.back().emission.constant = {5, 5, 5};
  // Its front, the side that shines, looks down and away from the floor.
  pictures::add_object(emitter, pictures::quad({0, 0, -1}, {1, 0, 0}, {0, -1, 0}), lamp);
  for (const Scene& scene : {point, sun, emitter})
    EXPECT_EQ(count(scene, GetParam()).rays.shadow, 0U);
}

TEST_P(Rays, DarkLightsAreNotThere) {
  const Scene bare = floor_of({0.5f, 0.5f, 0.5f});
  Scene dark = bare;
  dark.lights.push_back(pictures::point_light({0, 0, 2}, {0, 0, 0}));
  dark.lights.push_back(pictures::spot_light({0, 0, 2}, {0, 0, -1}, 40, 30, {0, 0, 0}));
  dark.lights.push_back(pictures::sun_light({0, 0, 1}, 1, {0, 0, 0}));
  dark.lights.push_back(pictures::constant_light({0, 0, 0}));
  dark.images.push_back(pictures::small_sky());
  dark.lights.push_back(pictures::image_light(0));
  dark.lights.back().color = {0, 0, 0};
  const int lamp = pictures::add_matte(dark, {0.5f, 0.5f, 0.5f});
  dark.materials.back().emits = true;
  pictures::add_object(dark, pictures::quad({0.8f, 0, 0.5f}, {0.1f, 0, 0}, {0, -0.1f, 0}), lamp);
  EXPECT_TRUE(scene_effects(dark, {}).lights.empty()) << "their code is left out";
  // Nothing shines: there is nothing to look for.
  const Counted nothing = count(dark, GetParam());
  EXPECT_EQ(nothing.rays.camera + nothing.rays.extension + nothing.rays.shadow, 0U);
  EXPECT_EQ(nothing.sum(), 0);
  // Beside one that shines they change neither a ray nor a bit.
  Scene both = dark, alone = bare;
  for (Scene* scene : {&both, &alone})
    scene->lights.push_back(pictures::point_light({0, 0, 2}, {1, 1, 1}));
  pictures::add_object(alone, both.objects.back().mesh,
                       pictures::add_matte(alone, {0.5f, 0.5f, 0.5f}));
  const Counted lit = count(both, GetParam()), wanted = count(alone, GetParam());
  EXPECT_EQ(lit.rays, wanted.rays);
  EXPECT_EQ(lit.film.rgb, wanted.film.rgb);
  EXPECT_GT(lit.sum(), 0);
}

TEST_P(Rays, ABlackSkyPictureIsNotSampled) {
  Scene scene = floor_of({0.5f, 0.5f, 0.5f});
  Image sky = pictures::small_sky();
  std::fill(sky.rgb.begin(), sky.rgb.end(), 0.0f);
  scene.images.push_back(sky);
  scene.lights.push_back(pictures::image_light(0));
  EXPECT_EQ(count(scene, GetParam()).rays.shadow, 0U);
}

TEST_P(Rays, AConstantSkyIsFoundByScatteredRaysAlone) {
  Scene scene = floor_of({0.5f, 0.5f, 0.5f});
  scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  const Counted c = count(scene, GetParam());
  EXPECT_EQ(c.rays.shadow, 0U);
  EXPECT_EQ(c.rays.extension, k_samples) << "a flat floor reflects each path into the sky";
}

TEST_P(Rays, ABlackFloorEndsPathsAndAsksForNoLight) {
  Scene scene = floor_of({0, 0, 0});
  scene.lights.push_back(pictures::point_light({0, 0, 2}, {1, 1, 1}));
  scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  const Counted c = count(scene, GetParam());
  EXPECT_EQ(c.rays, (RayCounts{k_samples, 0, 0}));
}

TEST_P(Rays, APathWhoseColourIsUsedUpEnds) {
  // Red throws red light at a green ceiling, which throws nothing of it back.
  Scene scene = floor_of({0.8f, 0, 0});
  pictures::add_object(scene, pictures::quad({0, 0, 2}, {90, 0, 0}, {0, 90, 0}),
                       pictures::add_matte(scene, {0, 0.8f, 0}));
  scene.lights.push_back(pictures::point_light({0, 0, 1.5f}, {1, 1, 1}));
  scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  EngineSettings engine = small_engine();
  engine.roulette_depth = 200;
  const Counted c = count(scene, GetParam(), engine);
  EXPECT_EQ(c.rays.camera, k_samples);
  EXPECT_EQ(c.rays.extension, k_samples) << "to the ceiling and no further";
  EXPECT_EQ(c.rays.shadow, k_samples) << "from the floor only";
}

TEST_P(Rays, AMirrorAsksForNoLight) {
  Scene scene;
  pictures::add_object(scene, pictures::quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}),
                       pictures::add_material(scene, "mirror"));
  scene.lights.push_back(pictures::point_light({0, 0, 2}, {1, 1, 1}));
  EXPECT_EQ(count(scene, GetParam()).rays.shadow, 0U);
}

TEST_P(Rays, TheLastBounceFollowsNoRayWhereNothingThatItMeetsCanShine) {
  // Only points shine: what the ray after the last vertex would meet is black to it.
  Scene scene = floor_of({0.5f, 0.5f, 0.5f});
  pictures::add_object(scene, pictures::quad({0, 0, 2}, {90, 0, 0}, {0, 90, 0}),
                       pictures::add_matte(scene, {0.5f, 0.5f, 0.5f}));
  scene.lights.push_back(pictures::point_light({0, 0, 1.5f}, {1, 1, 1}));
  EngineSettings engine = small_engine();
  engine.depth_total = 1;
  const Counted specialised = count(scene, false, engine);
  EXPECT_EQ(specialised.rays, (RayCounts{k_samples, 0, k_samples}));
  const Counted full = count(scene, true, engine);
  EXPECT_EQ(full.film.rgb, specialised.film.rgb) << "whose rays find nothing";
  // A sky may be what the ray meets.
  scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  EXPECT_EQ(count(scene, GetParam(), engine).rays.extension, k_samples);
}

TEST_P(Rays, CountingChangesNoBit) {
  for (const pictures::Picture& p : pictures::all_effects()) {
    const Counted c = count(p.scene, GetParam(), p.engine, p.camera);
    EXPECT_EQ(pictures::film_hash(c.film), pictures::film_hash(pictures::trace(p))) << p.name;
    EXPECT_GE(c.rays.camera, std::uint64_t{44} * 27 * 4) << p.name;
    EXPECT_GT(c.rays.shadow, 0U) << p.name;
  }
}

INSTANTIATE_TEST_SUITE_P(SpecialisedAndFull, Rays, testing::Bool());

TEST(RayCounts, AreTheSameForEveryLaneCount) {
  const pictures::Picture p = pictures::all_effects().back();
  std::vector<RayCounts> counts;
  for (const int lanes : {1, 4, 8, 16}) {
    TracerOptions options = pictures::tracer_options();
    options.count_rays = true;
    options.lanes = lanes;
    Tracer tracer(options);
    tracer.set_scene(p.scene);
    tracer.trace(p.camera, p.engine);
    counts.push_back(tracer.ray_counts());
    EXPECT_EQ(counts.back(), counts.front()) << lanes;
  }
}

TEST(RayCounts, MasksAndDepthsTraceNoPath) {
  Scene scene = floor_of({0.5f, 0.5f, 0.5f});
  scene.lights.push_back(pictures::point_light({0, 0, 2}, {1, 1, 1}));
  TracerOptions options = pictures::tracer_options();
  options.count_rays = true;
  Tracer tracer(options);
  tracer.set_scene(scene);
  tracer.trace_geometry(from_above(), k_width, k_height);
  RayCounts wanted;
  wanted.geometry = std::uint64_t{k_width} * k_height;
  EXPECT_EQ(tracer.ray_counts(), wanted);
  EXPECT_EQ(tracer.programs().programs, 0U) << "no path program is made";
}

TEST(RayCounts, APictureTracesNoMaskUnlessItsErrorIsOfTheModel) {
  Scene scene = floor_of({0.5f, 0.5f, 0.5f});
  scene.lights.push_back(pictures::point_light({0, 0, 2}, {1, 1, 1}));
  EXPECT_EQ(count(scene).rays.geometry, 0U);
  EngineSettings engine = small_engine();
  engine.target = ErrorTarget{1, 16, scene.tone_map};
  EXPECT_EQ(count(scene, false, engine).rays.geometry, 0U);
  engine.target->region = ErrorRegion::model;
  EXPECT_EQ(count(scene, false, engine).rays.geometry, std::uint64_t{k_width} * k_height);
}

TEST(RayCounts, AreNoneWhereTheyWereNotAskedFor) {
  Scene scene = floor_of({0.5f, 0.5f, 0.5f});
  scene.lights.push_back(pictures::point_light({0, 0, 2}, {1, 1, 1}));
  Tracer tracer(pictures::tracer_options());
  tracer.set_scene(scene);
  tracer.trace(from_above(), small_engine());
  tracer.trace_geometry(from_above(), k_width, k_height);
  EXPECT_EQ(tracer.ray_counts(), RayCounts{});
}

}  // namespace
}  // namespace ds
