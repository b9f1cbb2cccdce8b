// SPDX-License-Identifier: Apache-2.0
// Programs: one for each set of effects, got ready while another picture is traced.
#include "tracer/render/path_programs.h"

#include "tests/render/pictures.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <gtest/gtest.h>

namespace ds {
namespace {

class Programs : public testing::Test {
 protected:
  TracerOptions options() const {
    TracerOptions o;
    o.cache_folder = (folder_.path() / "cache").string();
    return o;
  }

  const std::vector<pictures::Picture> all_ = pictures::all_effects();

 private:
  TemporaryFolder folder_;
};

TEST(DefaultLanes, FollowTheVectorsOfTheProcessor) {
  const auto lanes = [](bool is_cpu, unsigned floats) {
    DeviceInfo device;
    device.is_cpu = is_cpu;
    device.float_lanes = floats;
    return default_lanes(device);
  };
  EXPECT_EQ(lanes(true, 16), 16);
  EXPECT_EQ(lanes(true, 8), 8);
  EXPECT_EQ(lanes(true, 4), 8);
  EXPECT_EQ(lanes(false, 1), 1);
  for (const DeviceInfo& device : list_devices())
    EXPECT_TRUE(device.float_lanes >= 1 && device.float_lanes <= 16) << device.name;
}

TEST_F(Programs, OneMadeAheadGivesTheSameBits) {
  const pictures::Picture &first = all_[0], &second = all_[1];
  Tracer tracer(options());
  tracer.set_scene(first.scene);
  tracer.prepare(first.camera, first.engine);
  EXPECT_FALSE(tracer.prepare_ahead(first.scene, first.camera, first.engine)) << "it is there";
  EXPECT_TRUE(tracer.prepare_ahead(second.scene, second.camera, second.engine));
  EXPECT_FALSE(tracer.prepare_ahead(second.scene, second.camera, second.engine)) << "on its way";
  const std::string first_hash = pictures::film_hash(tracer.trace(first.camera, first.engine));
  tracer.set_scene(second.scene);
  const std::string second_hash = pictures::film_hash(tracer.trace(second.camera, second.engine));
  EXPECT_EQ(first_hash, pictures::film_hash(pictures::trace(first)));
  EXPECT_EQ(second_hash, pictures::film_hash(pictures::trace(second)));
  const ProgramCounts counts = tracer.programs();
  EXPECT_EQ(counts.programs, 2U);
  EXPECT_EQ(counts.compiled, 2U);
  EXPECT_EQ(counts.ahead, 1U);
}

TEST_F(Programs, AreAsManyAsSetsOfEffects) {
  const pictures::Picture& p = all_[0];
  Tracer tracer(options());
  // Geometry, numbers and seeds are no effects; arithmetic and the lens are.
  Scene moved = p.scene;
  moved.objects.back().mesh = pictures::sphere({0, 0, 1}, 0.1f, 4, true);
  moved.lights.push_back(pictures::point_light({2, 2, 2}, {1, 1, 1}));
  EngineSettings other = p.engine;
  other.seed = 5;
  other.spp = 1;
  for (const Scene& scene : {p.scene, moved, p.scene}) {
    tracer.set_scene(scene);
    tracer.trace(p.camera, other);
  }
  EXPECT_EQ(tracer.programs().programs, 1U);
  Camera lens = p.camera;
  lens.lens_radius_m = 0.1;
  tracer.trace(lens, other);
  tracer.trace(p.camera, other);
  other.math = MathMode::fast;
  tracer.trace(p.camera, other);
  EXPECT_EQ(tracer.programs().programs, 3U);
  EXPECT_EQ(tracer.programs().compiled, 3U);
  Tracer next(options());
  next.set_scene(p.scene);
  next.trace(lens, p.engine);
  EXPECT_EQ(next.programs().programs, 1U);
  EXPECT_EQ(next.programs().compiled, 0U) << "kept by the first";
}

TEST_F(Programs, AFullProgramServesAll) {
  TracerOptions full = options();
  full.full_program = true;
  full.cache_folder = pictures::tracer_options().cache_folder;
  Tracer tracer(full);
  for (const pictures::Picture& p : all_) {
    tracer.set_scene(p.scene);
    tracer.trace(p.camera, p.engine);
    EXPECT_FALSE(tracer.prepare_ahead(all_[1].scene, all_[1].camera, p.engine));
  }
  EXPECT_EQ(tracer.programs().programs, 1U);
}

TEST_F(Programs, OneUnderWayDoesNotOutliveItsTracer) {
  const pictures::Picture& p = all_[2];
  Tracer tracer(options());
  EXPECT_TRUE(tracer.prepare_ahead(p.scene, p.camera, p.engine));
}

}  // namespace
}  // namespace ds
