// SPDX-License-Identifier: Apache-2.0
// The tracer as a whole: masks and depths against closed forms, order of calls, stopping.
#include "tests/render/pictures.h"
#include "tracer/base/error.h"
#include "tracer/scene/sdl.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <future>
#include <numbers>
#include <thread>

namespace ds {
namespace {

constexpr int k_width = 60, k_height = 40;

Camera from_the_front() {
  Camera camera;
  camera.position = {0, -3, 0};
  camera.fov_deg = 40;
  return camera;
}

/// Direction through a pixel's centre, of length 1 along +y.
Vec3d direction(int column, int row) {
  const double half = std::tan(40 * std::numbers::pi / 360);
  return {(2 * (column + 0.5) / k_width - 1) * half, 1,
          (1 - 2 * (row + 0.5) / k_height) * half * k_height / k_width};
}

Geometry geometry_of(const Scene& scene, const Camera& camera = from_the_front()) {
  Tracer tracer(pictures::tracer_options());
  tracer.set_scene(scene);
  return tracer.trace_geometry(camera, k_width, k_height);
}

/// A panel before the camera, under a sky of 1, whose matte colour is its mesh's; pixel by pixel.
Film panel_film(const std::vector<MeshColor>& colors) {
  pictures::Picture p;
  const int texture = pictures::add_texture(p.scene, "hitpointcolor", {});
  const int material = pictures::add_material(p.scene, "matte");
  p.scene.materials.back().inputs[0] = {{}, texture};
  Mesh mesh = pictures::quad({0, 0, 0}, {2, 0, 0}, {0, 0, 2});
  mesh.colors = colors;
  pictures::add_object(p.scene, std::move(mesh), material);
  p.scene.lights = {pictures::constant_light({1, 1, 1})};
  p.camera = from_the_front();
  p.engine.width = k_width;
  p.engine.height = k_height;
  p.engine.spp = 4;
  return pictures::trace(p);
}

TEST(MeshColors, AreWhatTheTextureShows) {
  // A matte surface that sees a sky of 1 alone shines with its albedo.
  const Film even = panel_film(std::vector<MeshColor>(4, {0.25f, 0.5f, 0.75f, 1}));
  const Film none = panel_film({});
  // Red grows from the left corners to the right ones.
  const Film grows = panel_film({{0, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}, {0, 0, 0, 1}});
  for (int row = 0; row < k_height; ++row)
    for (int column = 0; column < k_width; ++column) {
      const auto i = static_cast<std::size_t>(row * k_width + column) * 3;
      ASSERT_NEAR(even.rgb[i], 0.25f, 1e-5f);
      ASSERT_NEAR(even.rgb[i + 1], 0.5f, 1e-5f);
      ASSERT_NEAR(even.rgb[i + 2], 0.75f, 1e-5f);
      ASSERT_NEAR(none.rgb[i], 1.0f, 1e-5f);
      const double x = direction(column, row).x * 3;
      ASSERT_NEAR(double{grows.rgb[i]}, (x + 2) / 4, 0.03) << column;
    }
}

TEST(Geometry, ABoxIsMaskedAndDeepAsItsFront) {
  Scene scene;
  const int grey = pictures::add_matte(scene, {0.5f, 0.5f, 0.5f});
  pictures::add_object(scene, pictures::box({0.1f, 0, 0.05f}, {0.4f, 0.25f, 0.3f}), grey,
                       k_model_object_id);
  pictures::add_object(scene, pictures::quad({0, 2, 0}, {9, 0, 0}, {0, 0, 9}), grey, 5);
  const Geometry g = geometry_of(scene);
  int masked = 0;
  for (int row = 0; row < k_height; ++row)
    for (int column = 0; column < k_width; ++column) {
      const Vec3d d = direction(column, row);
      // Only the front, at y = -0.25, is seen: the sides fall away from the camera.
      const Vec3d at = d * 2.75;
      const bool inside = std::fabs(at.x - 0.1) < 0.4 && std::fabs(at.z - 0.05) < 0.3;
      const auto i = static_cast<std::size_t>(row * k_width + column);
      ASSERT_EQ(g.mask[i], inside ? 255 : 0) << column << ", " << row;
      ASSERT_NEAR(double{g.depth[i]}, inside ? 2.75 : 5.0, 1e-5) << column << ", " << row;
      masked += inside;
    }
  EXPECT_GT(masked, 200);
}

TEST(Geometry, ASpheresDepthIsItsEquations) {
  Scene scene;
  pictures::add_object(scene, pictures::sphere({0, 0, 0}, 0.6f, 200, true),
                       pictures::add_matte(scene, {1, 1, 1}), k_model_object_id);
  const Geometry g = geometry_of(scene);
  for (int row = 0; row < k_height; ++row)
    for (int column = 0; column < k_width; ++column) {
      // |(0, -3, 0) + t d| = 0.6; the direction's part along the axis is 1, so t is the depth.
      const Vec3d d = direction(column, row);
      const double a = dot(d, d);
      const double discriminant = 9 - a * (9 - 0.36);
      const auto i = static_cast<std::size_t>(row * k_width + column);
      if (std::fabs(discriminant) < 0.02)
        continue;  // the silhouette, where facets differ from the sphere
      ASSERT_EQ(g.mask[i], discriminant > 0 ? 255 : 0);
      if (discriminant > 0)
        ASSERT_NEAR(double{g.depth[i]}, (3 - std::sqrt(discriminant)) / a, 2e-3);
      else
        ASSERT_EQ(g.depth[i], 0);
    }
}

TEST(Geometry, TheMaskIsThatOfTheNearest) {
  Scene scene;
  const int grey = pictures::add_matte(scene, {0.5f, 0.5f, 0.5f});
  pictures::add_object(scene, pictures::quad({0, 0, 0}, {1, 0, 0}, {0, 0, 1}), grey,
                       k_model_object_id);
  pictures::add_object(scene, pictures::quad({-0.5f, -1, 0}, {0.5f, 0, 0}, {0, 0, 1}), grey, 9);
  const Geometry g = geometry_of(scene);
  EXPECT_EQ(g.mask[20 * k_width + 10], 0);
  EXPECT_EQ(g.mask[20 * k_width + 50], 255);
  EXPECT_NEAR(g.depth[20 * k_width + 10], 2, 1e-6);
}

TEST(Geometry, NeedsNeitherMaterialNorLightNorLens) {
  const pictures::Picture p = pictures::all_effects().back();
  Camera pinhole = p.camera;
  pinhole.lens_radius_m = 0;
  EXPECT_EQ(geometry_of(p.scene, p.camera).depth, geometry_of(p.scene, pinhole).depth);
}

TEST(Geometry, DoesNotDisturbThePicturesAroundIt) {
  const pictures::Picture p = pictures::all_effects()[0];
  const std::string alone = pictures::film_hash(pictures::trace(p));
  Tracer tracer(pictures::tracer_options());
  tracer.set_scene(p.scene);
  tracer.trace_geometry(p.camera, 10, 10);
  EXPECT_EQ(pictures::film_hash(tracer.trace(p.camera, p.engine)), alone);
  tracer.trace_geometry(p.camera, 10, 10);
  EXPECT_EQ(pictures::film_hash(tracer.trace(p.camera, p.engine)), alone);
}

TEST(Tracer, WithoutASceneIsAnError) {
  Tracer tracer(pictures::tracer_options());
  EXPECT_THROW(tracer.trace(Camera{}, EngineSettings{}), Error);
  EXPECT_THROW(tracer.trace_geometry(Camera{}, 4, 4), Error);
}

TEST(Tracer, StopsWhereAsked) {
  const pictures::Picture p = pictures::all_effects()[0];
  Tracer tracer(pictures::tracer_options());
  tracer.set_scene(p.scene);
  const std::atomic<bool> stop = true;
  try {
    tracer.trace(p.camera, p.engine, {}, &stop);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::cancelled);
  }
}

TEST(Tracer, RefusesATreeWidthThatThereIsNot) {
  for (const int width : {-1, 0, 1, 9}) {
    TracerOptions options = pictures::tracer_options();
    options.bvh_width = width;
    try {
      const Tracer tracer(options);
      ADD_FAILURE() << width;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_EQ(error.what(), fmt::format("bvh_width must be in [2, 8], got {}", width));
    }
  }
}

TEST(Tracer, ProgressEndsAtAllSamples) {
  const pictures::Picture p = pictures::all_effects()[0];
  Tracer tracer(pictures::tracer_options());
  tracer.set_scene(p.scene);
  TraceProgress last;
  tracer.trace(p.camera, p.engine, [&](const TraceProgress& now) {
    EXPECT_GE(now.samples_done, last.samples_done);
    last = now;
  });
  EXPECT_EQ(last.samples_done, last.samples_total);
  EXPECT_EQ(last.samples_total, std::uint64_t{44} * 27 * 4);
}

TEST(Tracer, ALensOfNoRadiusGivesThePinholesBits) {
  pictures::Picture p = pictures::all_effects()[0];
  const Film pinhole = pictures::trace(p);
  TracerOptions full = pictures::tracer_options();
  full.full_program = true;
  EXPECT_EQ(pictures::trace(p, full).rgb, pinhole.rgb);
  p.camera.lens_radius_m = 1e-9;
  const Film tiny = pictures::trace(p);
  double difference = 0, sum = 0;
  for (std::size_t i = 0; i < tiny.rgb.size(); ++i) {
    difference += std::fabs(double{tiny.rgb[i]} - double{pinhole.rgb[i]});
    sum += double{pinhole.rgb[i]};
  }
  EXPECT_LT(difference, 0.02 * sum);
}

/// A box on a plate, under a picture of a sky.
pictures::Picture box_under_a_sky(Vec3 half) {
  pictures::Picture p;
  const int material = pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f});
  pictures::add_object(p.scene, pictures::quad({0, 0, -1}, {5, 0, 0}, {0, 5, 0}), material);
  pictures::add_object(p.scene, pictures::box({0, 0, 0}, half), material, k_model_object_id);
  p.scene.images = {pictures::small_sky()};
  p.scene.lights = {pictures::image_light(0)};
  p.camera = from_the_front();
  p.engine.width = k_width;
  p.engine.height = k_height;
  p.engine.spp = 2;
  return p;
}

TEST(ReadyScenes, HaveTheSameBitsMadeInAnotherThread) {
  const pictures::Picture first = box_under_a_sky({0.5f, 0.5f, 0.5f});
  const pictures::Picture second = box_under_a_sky({0.3f, 0.5f, 0.7f});
  const std::string wanted = pictures::film_hash(pictures::trace(second));
  Tracer tracer(pictures::tracer_options());
  for (const SceneUse use : {SceneUse::pictures, SceneUse::planes}) {
    auto next = std::async(std::launch::async,
                           [&] { return tracer.make_ready(second.scene, use, second.engine); });
    tracer.set_scene(first.scene);
    tracer.trace(first.camera, first.engine);
    tracer.set_scene(next.get());
    tracer.trace_geometry(second.camera, k_width, k_height);
    EXPECT_EQ(pictures::film_hash(tracer.trace(second.camera, second.engine)), wanted);
  }
}

TEST(ReadyScenes, ForPlanesReadNoImageAndUploadNoTable) {
  pictures::Picture p = box_under_a_sky({0.5f, 0.5f, 0.5f});
  const Geometry wanted = geometry_of(p.scene, p.camera);
  p.scene.images[0] = {};
  p.scene.images[0].file = "there-is-no-such.hdr";
  Tracer tracer(pictures::tracer_options());
  EXPECT_THROW(tracer.make_ready(p.scene, SceneUse::pictures, p.engine), Error);
  tracer.set_scene(tracer.make_ready(p.scene, SceneUse::planes, p.engine));
  EXPECT_EQ(tracer.trace_geometry(p.camera, k_width, k_height).depth, wanted.depth);
  EXPECT_THROW(tracer.trace(p.camera, p.engine), Error);
}

TEST(Uploads, AreOfWhatTheNextSceneHasOfItsOwn) {
  const pictures::Picture first = box_under_a_sky({0.5f, 0.5f, 0.5f});
  const pictures::Picture second = box_under_a_sky({0.3f, 0.5f, 0.7f});
  const std::string wanted = pictures::film_hash(pictures::trace(second));
  Tracer tracer(pictures::tracer_options());
  tracer.set_scene(first.scene);
  tracer.trace(first.camera, first.engine);
  const UploadCounts before = tracer.uploads();
  EXPECT_EQ(before.tables, 8U);
  EXPECT_EQ(before.kept_tables, 0U);
  tracer.set_scene(second.scene);
  const Film film = tracer.trace(second.camera, second.engine);
  const UploadCounts after = tracer.uploads();
  // Its tree and triangles; materials, their programs, lights, the sky's tables and the scene's
  // numbers are there.
  EXPECT_EQ(after.tables - before.tables, 3U);
  EXPECT_EQ(after.kept_tables, 5U);
  EXPECT_EQ(pictures::film_hash(film), wanted);
  // The same again: nothing is.
  tracer.set_scene(second.scene);
  tracer.trace(second.camera, second.engine);
  EXPECT_EQ(tracer.uploads().bytes, after.bytes);
  EXPECT_EQ(tracer.uploads().kept_tables, 13U);
}

}  // namespace
}  // namespace ds
