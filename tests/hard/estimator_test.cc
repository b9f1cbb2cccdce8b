// SPDX-License-Identifier: Apache-2.0
// Roulette, multiple importance sampling and the sampler change a picture's noise, never its mean:
// t-tests for every material of the table. |z| < 4.5 fails a right program once in 150,000 tests.
#include "tests/hard/everywhere.h"
#include "tests/tracer/kernels/chi_square.h"
#include "tests/tracer/kernels/materials.h"
#include "tracer/device/scene_pack.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

namespace ds {
namespace {

using pictures::Estimate;
using pictures::Picture;

constexpr double k_z = 4.5;

const std::vector<hard::Way> k_two_ways = {{}, {MathMode::fast, 1, true}};

void expect_same_mean(const Estimate& a, const Estimate& b, const std::string& what) {
  EXPECT_NEAR(a.mean, b.mean, k_z * std::hypot(a.error, b.error) + 1e-6 * a.mean) << what;
  // A test of nothing, or of noise alone, would pass.
  EXPECT_GT(a.mean, 0.05) << what;
  EXPECT_LT(a.error, 0.05 * a.mean) << what;
}

/// Two bodies of the material on a light floor.
Picture still_life(const std::string& material) {
  Picture p = hard::deep_picture(12, 32);
  p.engine.depth_total = 24;
  const int floor = pictures::add_matte(p.scene, {0.7f, 0.7f, 0.7f});
  const int body = hard::add_material(p.scene, material);
  pictures::add_object(p.scene, pictures::quad({0, 0, -0.5f}, {2, 0, 0}, {0, 2, 0}), floor);
  pictures::add_object(p.scene, pictures::sphere({-0.3f, 0.2f, 0}, 0.45f, 12, true), body);
  pictures::add_object(p.scene, pictures::box({0.5f, -0.2f, -0.2f}, {0.25f, 0.2f, 0.25f}), body);
  p.camera.position = {0.3, -2.2, 1.1};
  return p;
}

TEST(Estimator, RouletteDoesNotChangeTheMean) {
  for (const std::string& material : hard::materials(true)) {
    Picture with = still_life(material);
    with.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
    with.scene.lights.push_back(pictures::point_light({-1, -1, 2}, {2, 2, 2}));
    Picture without = with;
    with.engine.roulette_depth = 1;
    with.engine.roulette_cap = 0.1f;
    for (const hard::Way& way : k_two_ways)
      expect_same_mean(hard::estimate(with, way, 16), hard::estimate(without, way, 16, 1000),
                       material + ", " + way.name());
  }
}

TEST(Estimator, SamplingTheLightToo) {
  // A constant sky is met by BSDF samples alone; an image of the same radiance is sampled as well,
  // and the two are weighed against each other (Veach's power heuristic).
  Image ones;
  ones.width = 8;
  ones.height = 4;
  ones.rgb.assign(8 * 4 * 3, 1.0f);
  for (const std::string& material : hard::materials(true)) {
    Picture one_strategy = still_life(material);
    one_strategy.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
    Picture two = still_life(material);
    two.scene.images.push_back(ones);
    two.scene.lights.push_back(pictures::image_light(0));
    for (const hard::Way& way : k_two_ways)
      expect_same_mean(hard::estimate(one_strategy, way, 16), hard::estimate(two, way, 16, 1000),
                       material + ", " + way.name());
  }
}

/// The light tables of a scene on the host.
class HostLights {
 public:
  explicit HostLights(const Scene& scene) {
    const PackedScene packed = pack_scene(scene, scene_effects(scene, Camera{}), BvhQuality::low);
    for (const auto& [from, to] : {std::pair{&packed.lights, &lights_}, {&packed.tables, &tables_}})
      for (const std::uint32_t word : from->words())
        to->push_back(std::bit_cast<float>(word));
  }
  kernels::LightTables tables() const { return {lights_.data(), tables_.data(), nullptr}; }

 private:
  std::vector<float> lights_, tables_;
};

TEST(Estimator, AnotherSamplerAndOneStrategy) {
  // One surface under a sky, seen from one direction, with depth 1: on the host with numbers of
  // std::mt19937 and BSDF samples only; on the device with Sobol's, and the sky sampled as well.
  for (const materials::Case& material : materials::all()) {
    Picture p = hard::deep_picture(8, 64);
    p.engine.depth_total = 1;
    p.scene.images.push_back(pictures::small_sky());
    for (float& v : p.scene.images[0].rgb)
      v = std::min(v, 5.0f);
    p.scene.lights.push_back(pictures::image_light(0));
    pictures::add_object(p.scene, pictures::quad({}, {1, 0, 0}, {0, 1, 0}),
                         hard::add_material(p.scene, material.name));
    p.camera.position = {6e3, -5e3, 7e3};
    p.camera.fov_deg = 0.001;
    const HostLights lights(p.scene);
    const Vec3d way = normalized(p.camera.position);
    kernels::Viewer viewer;
    viewer.wo = kernels::vec(static_cast<float>(way.x), static_cast<float>(way.y),
                             static_cast<float>(way.z));
    viewer.outside = true;
    const std::vector<float> inputs = materials::inputs(material, 0.1f);
    std::mt19937 random(9);
    const auto number = [&] {
      return kernels::unit_interval(static_cast<kernels::uint>(random()));
    };
    constexpr int k_samples = 400000;
    double sum = 0, squares = 0;
    for (int i = 0; i < k_samples; ++i) {
      const kernels::real2 u = {number(), number()};
      const kernels::BsdfSample s = material.sample(inputs.data(), viewer, u, {number(), number()});
      if (!s.valid) continue;
      float pdf = 0;
      const kernels::real3 sky =
          kernels::infinite_escape(lights.tables(), kernels::k_light_parameters, s.wi, &pdf);
      const double v = double{s.weight.x * sky.x + s.weight.y * sky.y + s.weight.z * sky.z} / 3;
      sum += v;
      squares += v * v;
    }
    Estimate host;
    host.mean = sum / k_samples;
    host.error = std::sqrt((squares / k_samples - host.mean * host.mean) / k_samples);
    for (const hard::Way& on : k_two_ways)
      expect_same_mean(host, hard::estimate(p, on, 16),
                       std::string(material.name) + ", " + on.name());
  }
}

/// By pixel: the mean of its channels over independent pictures, and that mean's squared error.
struct PixelMoments {
  std::vector<double> mean, squared_error;
};

PixelMoments pixel_moments(const Picture& picture, const hard::Way& way, int pictures,
                           std::uint64_t first_seed) {
  const std::size_t pixels = static_cast<std::size_t>(picture.engine.width) *
                             static_cast<std::size_t>(picture.engine.height);
  PixelMoments m{std::vector<double>(pixels), std::vector<double>(pixels)};
  Picture p = picture;
  for (int k = 0; k < pictures; ++k) {
    p.engine.seed = pictures::wide_seed(first_seed + static_cast<std::uint64_t>(k));
    const Film film = hard::trace(p, way);
    EXPECT_EQ(film.rejected_samples, 0u);
    for (std::size_t i = 0; i < pixels; ++i) {
      const double v = double{film.rgb[3 * i] + film.rgb[3 * i + 1] + film.rgb[3 * i + 2]} / 3;
      const double step = v - m.mean[i];  // Welford 1962
      m.mean[i] += step / (k + 1);
      m.squared_error[i] += step * (v - m.mean[i]);
    }
  }
  for (double& e : m.squared_error)
    e /= double{pictures - 1.0} * pictures;
  return m;
}

/// How many pixels differ by more than chance: at 0.01 for all together (Sidak).
std::size_t pixels_that_differ(const PixelMoments& a, const PixelMoments& b) {
  const double limit = sidak(static_cast<double>(a.mean.size()));
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.mean.size(); ++i) {
    const double error = std::sqrt(a.squared_error[i] + b.squared_error[i]);
    const double z = std::fabs(a.mean[i] - b.mean[i]) / (error + 1e-6 * a.mean[i] + 1e-30);
    differ += std::erfc(z / std::sqrt(2.0)) < limit;
  }
  return differ;
}

TEST(Estimator, IndependentPicturesAgreePixelByPixel) {
  // Other samples, arithmetic, lanes and program (Mitsuba's test_renders.py: a z-test at 0.01 with
  // Sidak, passed by 99.75 % of the pixels).
  for (Picture picture : pictures::all_effects()) {
    picture.engine.spp = 8;
    constexpr int k_pictures = 32;
    const PixelMoments a = pixel_moments(picture, k_two_ways[0], k_pictures, 1);
    const std::size_t most = a.mean.size() / 400;
    EXPECT_LE(pixels_that_differ(a, pixel_moments(picture, k_two_ways[1], k_pictures, 1000)), most)
        << picture.name;
    // It can tell: a light a twentieth brighter is seen.
    if (picture.name != "textures") continue;
    for (Light& light : picture.scene.lights)
      light.color = light.color * 1.05f;
    EXPECT_GT(pixels_that_differ(a, pixel_moments(picture, k_two_ways[1], k_pictures, 1000)),
              10 * most)
        << picture.name;
  }
}

TEST(Estimator, FastAgreesWithStrictPixelByPixel) {
  // The same samples: rounding turns a path another way here and there, and no more. (Against
  // independent samples a pixel that a rare bright path reaches says nothing: its variance is not
  // in a hundred pictures.)
  for (Picture picture : pictures::all_effects()) {
    picture.engine.spp = 64;
    const Film strict = hard::trace(picture, {});
    for (const hard::Way& way : {hard::Way{MathMode::fast}, k_two_ways[1]}) {
      const Film fast = hard::trace(picture, way);
      EXPECT_EQ(fast.rejected_samples, 0u);
      EXPECT_NEAR(hard::mean_of(fast), hard::mean_of(strict), 1e-3 * hard::mean_of(strict));
      std::size_t differ = 0;
      for (std::size_t i = 0; i < fast.rgb.size(); ++i)
        differ += std::fabs(fast.rgb[i] - strict.rgb[i]) > 0.01f * strict.rgb[i];
      EXPECT_LT(differ, fast.rgb.size() / 50) << picture.name << ", " << way.name();
    }
  }
}

}  // namespace
}  // namespace ds
