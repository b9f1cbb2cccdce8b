// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/film.h"

#include "tracer/base/error.h"
#include "tracer/kernels/layout.h"
#include "tracer/render/film_error.h"

#include <algorithm>

namespace ds {
namespace {

double total(std::span<const float> plane) {
  double sum = 0;
  for (const float value : plane)
    sum += double{value};
  return sum;
}

std::uint64_t count(const FilmSums& sums, int plane) {
  return static_cast<std::uint64_t>(total(sums.plane(plane)));
}

/// Luminance that scaling outliers down took, over what there would be with it.
double removed_share(const FilmSums& sums) {
  const double removed = total(sums.plane(kernels::k_film_removed));
  if (!(removed > 0)) return 0;
  constexpr double weights[3] = {k_luminance_r, k_luminance_g, k_luminance_b};
  double kept = 0;
  for (int c = 0; c < 3; ++c)
    kept += weights[c] * total(sums.plane(kernels::k_film_sum + c));
  return removed / (kept + removed);
}

}  // namespace

std::size_t FilmSums::tile_pixels(std::size_t tile) const {
  const std::size_t x = tile % tiles_x() * k_tile_size, y = tile / tiles_x() * k_tile_size;
  return std::min<std::size_t>(k_tile_size, static_cast<std::size_t>(width) - x) *
         std::min<std::size_t>(k_tile_size, static_cast<std::size_t>(height) - y);
}

std::uint64_t FilmSums::samples() const {
  std::uint64_t sum = 0;
  for (std::size_t tile = 0; tile < tile_spp.size(); ++tile)
    sum += std::uint64_t{tile_spp[tile]} * tile_pixels(tile);
  return sum;
}

PixelEstimate pixel_of(const FilmSums& film, std::size_t pixel, std::uint32_t spp) {
  PixelEstimate estimate;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto value = [&](int plane) {
      return double{film.planes[(static_cast<std::size_t>(plane) + c) * film.pixels() + pixel]};
    };
    const double sum = value(kernels::k_film_sum) + value(kernels::k_film_compensation);
    estimate.mean[c] = static_cast<float>(sum / spp);
    if (spp < 2) continue;
    // An odd count leaves the even half one sample longer: its surplus is taken out as one mean.
    const double surplus = spp % 2 == 1 ? sum / spp : 0.0;
    estimate.half[c] = static_cast<float>((value(kernels::k_film_halves) - surplus) / spp);
  }
  return estimate;
}

FilmSums empty_film(int width, int height) {
  FilmSums sums;
  sums.width = width;
  sums.height = height;
  sums.tile_spp.assign(sums.tiles_x() * sums.tiles_y(), 0);
  sums.planes.assign(sums.pixels() * kernels::k_film_planes, 0.0f);
  return sums;
}

Film film_of(const FilmSums& sums) {
  DS_ASSERT(!sums.empty());
  Film film;
  film.width = sums.width;
  film.height = sums.height;
  film.rgb.resize(sums.pixels() * 3);
  const auto [least, most] = std::minmax_element(sums.tile_spp.begin(), sums.tile_spp.end());
  DS_ASSERT(*least > 0);
  if (*least > 1) film.halves.resize(film.rgb.size());
  for (std::size_t tile = 0; tile < sums.tile_spp.size(); ++tile)
    sums.visit_tile(tile, [&](std::size_t pixel) {
      const PixelEstimate estimate = pixel_of(sums, pixel, sums.tile_spp[tile]);
      std::copy_n(estimate.mean.begin(), 3, film.rgb.data() + 3 * pixel);
      if (!film.halves.empty())
        std::copy_n(estimate.half.begin(), 3, film.halves.data() + 3 * pixel);
    });
  FilmFacts& facts = film.facts;
  facts.samples = sums.samples();
  facts.least_spp = *least;
  facts.most_spp = *most;
  facts.nan_samples = count(sums, kernels::k_film_nan);
  facts.infinite_samples = count(sums, kernels::k_film_infinite);
  facts.negative_samples = count(sums, kernels::k_film_negative);
  facts.outlier_samples = count(sums, kernels::k_film_outliers);
  facts.removed_energy = removed_share(sums);
  film.rejected_samples = facts.nan_samples + facts.infinite_samples + facts.negative_samples;
  if (const auto error = luminance_error(film)) {
    film.relative_error = error->value;
    facts.error_low = error->low;
    facts.error_high = error->high;
  }
  return film;
}

}  // namespace ds
