// SPDX-License-Identifier: Apache-2.0
// Samples are added to the quarter of the pixel that they lie in, as many to each.
#include "tests/render/pictures.h"
#include "tracer/kernels/layout.h"
#include "tracer/render/film.h"

#include <gtest/gtest.h>

namespace ds {
namespace {

constexpr int k_side = 5, k_middle = 2;
constexpr int k_spp = 64;

/// A black quad before a light of radiance 1 all around; its edges go through the middle of the
/// picture, which is that of a pixel.
FilmSums film_behind(Vec3 centre, Vec3 half_u, Vec3 half_v, int lanes) {
  pictures::Picture p;
  p.camera.position = {0, -2, 0};
  p.camera.target = {0, 0, 0};
  p.engine.width = p.engine.height = k_side;
  p.engine.spp = k_spp;
  pictures::add_object(p.scene, pictures::quad(centre, half_u, half_v),
                       pictures::add_matte(p.scene, {0, 0, 0}));
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  TracerOptions options = pictures::tracer_options();
  options.lanes = lanes;
  Tracer tracer(options);
  tracer.set_scene(p.scene);
  FilmSums film;
  tracer.trace(p.camera, p.engine, {}, nullptr, &film);
  return film;
}

float value(const FilmSums& film, std::size_t x, std::size_t y, std::size_t quarter, int plane) {
  return film.planes[film.place(x, y) +
                     (quarter * kernels::k_film_quarter + static_cast<std::size_t>(plane)) *
                         kernels::k_tile_pixels];
}

float mean(const FilmSums& film, std::size_t x, std::size_t y, std::size_t quarter) {
  return value(film, x, y, quarter, kernels::k_film_sum) /
         value(film, x, y, quarter, kernels::k_film_count);
}

class FilmQuarters : public testing::TestWithParam<int> {};

/// Sobol' points of 2^k lie evenly in the four quarters, and so do the even and the odd ones.
TEST_P(FilmQuarters, HaveAsManySamples) {
  const FilmSums film = film_behind({-4, 0, 0}, {4, 0, 0}, {0, 0, 4}, GetParam());
  for (std::size_t y = 0; y < k_side; ++y)
    for (std::size_t x = 0; x < k_side; ++x)
      for (std::size_t q = 0; q < 4; ++q) {
        EXPECT_EQ(value(film, x, y, q, kernels::k_film_count), k_spp / 4)
            << x << " " << y << " " << q;
        EXPECT_EQ(value(film, x, y, q, kernels::k_film_count_halves), 0);
      }
}

TEST_P(FilmQuarters, LeftAndRightAreApart) {
  const FilmSums film = film_behind({-4, 0, 0}, {4, 0, 0}, {0, 0, 4}, GetParam());
  for (std::size_t y = 0; y < k_side; ++y)
    for (std::size_t q = 0; q < 4; ++q) {
      EXPECT_EQ(mean(film, k_middle - 1, y, q), 0);
      EXPECT_EQ(mean(film, k_middle, y, q), q % 2) << y << " " << q;
      EXPECT_EQ(mean(film, k_middle + 1, y, q), 1);
    }
}

TEST_P(FilmQuarters, UpperAndLowerAreApart) {
  const FilmSums film = film_behind({0, 0, 4}, {4, 0, 0}, {0, 0, 4}, GetParam());
  for (std::size_t x = 0; x < k_side; ++x)
    for (std::size_t q = 0; q < 4; ++q) {
      EXPECT_EQ(mean(film, x, k_middle - 1, q), 0);
      EXPECT_EQ(mean(film, x, k_middle, q), q / 2) << x << " " << q;
      EXPECT_EQ(mean(film, x, k_middle + 1, q), 1);
    }
}

INSTANTIATE_TEST_SUITE_P(Lanes, FilmQuarters, testing::Values(1, 8, 16));

}  // namespace
}  // namespace ds
