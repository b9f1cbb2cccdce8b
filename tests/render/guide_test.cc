// SPDX-License-Identifier: Apache-2.0
// The guide to caustics: where photons fall, what the table makes of them, that directions follow
// their density, and that pictures keep their mean and lose their fireflies.
#include "tracer/render/guide.h"

#include "tests/render/pictures.h"
#include "tests/tracer/kernels/chi_square.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/scene/sdl.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numeric>
#include <random>

namespace ds {
namespace {

using pictures::Picture;

std::vector<float> as_floats(const std::vector<std::uint32_t>& words) {
  std::vector<float> values;
  for (const std::uint32_t word : words)
    values.push_back(std::bit_cast<float>(word));
  return values;
}

/// Photons on the ground at the origin from two places `far` metres up and aside.
std::vector<Photon> from_two_places(float far) {
  std::vector<Photon> photons;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> some(-0.05f, 0.05f);
  for (int i = 0; i < 400; ++i) {
    const Vec3 source = far * (i % 4 == 0 ? Vec3{1, 0, 1} : Vec3{-1, 0, 1});
    photons.push_back({{some(random), some(random), 0},
                       source + Vec3{some(random), some(random), some(random)},
                       1});
  }
  return photons;
}

/// `started`: photons, which decides on the size of cells.
void expect_to_look_at_two_places(std::size_t started) {
  const std::vector<float> table =
      as_floats(guide_table(from_two_places(1), started, {0, 0, 0}, 1));
  const auto guide = [&](float x, float y, float z) {
    return kernels::guide_at(table.data(), true, kernels::vec(x, y, z));
  };
  const kernels::Guide there = guide(0.01f, 0.01f, 0);
  ASSERT_TRUE(there.there);
  double weights = 0, right = 0;
  for (const kernels::GuideLobe& lobe : there.lobes) {
    weights += double{lobe.weight};
    if (lobe.axis.x > 0) right += double{lobe.weight};
    // Either place is seen at 45 degrees, and its photons came from a twentieth of the way around.
    if (lobe.weight > 0) {
      EXPECT_NEAR(std::abs(lobe.axis.x), std::sqrt(0.5), 0.06);
    }
  }
  EXPECT_NEAR(weights, 1, 1e-6);
  EXPECT_NEAR(right, 0.25, 0.1);
  EXPECT_FALSE(kernels::guide_at(table.data(), false, kernels::vec(0.01f, 0.01f, 0)).there);
  EXPECT_FALSE(guide(2, 0, 0).there);
  EXPECT_FALSE(guide(100, 0, 0).there);
  EXPECT_FALSE(guide(NAN, 0, 0).there);
}

TEST(Guide, LooksToWherePhotonsCameFrom) {
  expect_to_look_at_two_places(k_photons_of_fine_cells);
  expect_to_look_at_two_places(400);
  const std::vector<float> none = as_floats(guide_table({}, 0, {0, 0, 0}, 1));
  EXPECT_FALSE(kernels::guide_at(none.data(), true, kernels::vec(0, 0, 0)).there);
}

/// By cells of equal solid angle; also from inside a sphere, where the lobe is half of all
/// directions.
TEST(Guide, DirectionsFollowTheirDensity) {
  constexpr SphereCells cells{20, 40};
  constexpr int k_samples = 200000;
  for (const float away : {1.0f, 0.03f}) {
    const std::vector<float> table =
        as_floats(guide_table(from_two_places(away), k_photons_of_fine_cells, {0, 0, 0}, 1));
    const kernels::Guide guide = kernels::guide_at(table.data(), true, kernels::vec(0, 0, 0));
    ASSERT_TRUE(guide.there);
    std::vector<double> counts(cells.count());
    std::mt19937 random(3);
    std::uniform_real_distribution<float> some(0, 1);
    for (int i = 0; i < k_samples; ++i) {
      const kernels::real3 wi =
          kernels::guide_sample(&guide, some(random), {some(random), some(random)});
      counts[cells.cell(wi.x, wi.y, wi.z)] += 1;
    }
    std::vector<double> expected = cells.integrals(30, [&](double z, double azimuth) {
      const double s = std::sqrt(1 - z * z);
      return kernels::guide_pdf(
          &guide, kernels::vec(static_cast<float>(s * std::cos(azimuth)),
                               static_cast<float>(s * std::sin(azimuth)), static_cast<float>(z)));
    });
    const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
    EXPECT_NEAR(total, 1, 2e-3) << away;
    for (double& e : expected)
      e *= k_samples / total;
    EXPECT_GT(chance_of_counts(counts, expected), 0.005) << away;
  }
}

/// A glossy ball that a small sun shines on, on matte ground. `id`: k_model_object_id lets the
/// ground look for the ball's caustic.
Picture ball_in_the_sun(std::uint32_t id, std::string_view material = "glossy2") {
  Picture p{std::string(material), {}, {}, {}};
  const int ground = pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f});
  pictures::add_object(p.scene, pictures::quad({0, 0, 0}, {3, 0, 0}, {0, 3, 0}), ground);
  const int caster = pictures::add_material(p.scene, material);
  pictures::add_object(p.scene, pictures::sphere({0, 0, 0.5f}, 0.5f, 16, true), caster, id);
  p.scene.lights.push_back(pictures::sun_light({0.8f, 0, 0.6f}, 0.5, {1000, 1000, 1000}));
  p.camera.position = {0.5, -2.5, 2};
  p.camera.target = {0.3, 0, 0.2};
  p.engine.width = p.engine.height = 24;
  p.engine.spp = 64;
  return p;
}

TEST(Guide, IsForModelsThatCastCausticsAmongReceiversOnly) {
  const auto guided = [](const Scene& scene) { return scene_effects(scene, Camera{}).guide; };
  EXPECT_TRUE(guided(ball_in_the_sun(k_model_object_id).scene));
  EXPECT_FALSE(guided(ball_in_the_sun(7).scene));
  EXPECT_FALSE(guided(ball_in_the_sun(k_model_object_id, "matte").scene));
  // A mirror has one lobe, and the guide chooses all the same.
  const Scene mirror = ball_in_the_sun(k_model_object_id, "mirror").scene;
  EXPECT_TRUE(guided(mirror));
  EXPECT_FALSE(scene_effects(mirror, Camera{}).lobe_choice);
  Scene dark = ball_in_the_sun(k_model_object_id).scene;
  dark.lights = {pictures::constant_light({1, 1, 1})};
  EXPECT_FALSE(guided(dark));
}

/// The same scene where the ball is not the model: another program, the same picture.
TEST(Guide, KeepsThePicturesMean) {
  for (const std::string material : {"glossy2", "metal2", "glass"}) {
    const auto with = pictures::estimate_pixels(ball_in_the_sun(k_model_object_id, material), 24);
    const auto without = pictures::estimate_pixels(ball_in_the_sun(7, material), 24, 500);
    double sum_with = 0, sum_without = 0, guided = 0, variance = 0;
    for (std::size_t i = 0; i < with.size(); ++i) {
      sum_with += with[i].mean;
      sum_without += without[i].mean;
      guided += with[i].error * with[i].error;
      variance += with[i].error * with[i].error + without[i].error * without[i].error;
    }
    EXPECT_LT(std::abs(sum_with - sum_without), 4 * std::sqrt(variance)) << material;
    EXPECT_LT(std::sqrt(guided), 0.02 * sum_with) << material;
  }
}

TEST(Guide, TakesMostOfACausticsNoise) {
  const auto squares = [](const Picture& picture) {
    double sum = 0;
    for (const pictures::Estimate& e : pictures::estimate_pixels(picture, 12))
      sum += e.error * e.error;
    return sum;
  };
  const double ratio = squares(ball_in_the_sun(k_model_object_id)) / squares(ball_in_the_sun(7));
  EXPECT_LT(ratio, 0.5);
}

}  // namespace
}  // namespace ds
