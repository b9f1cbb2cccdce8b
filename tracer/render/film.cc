// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/film.h"

#include "tracer/base/error.h"
#include "tracer/base/luminance.h"
#include "tracer/base/parallel.h"
#include "tracer/kernels/layout.h"
#include "tracer/render/film_error.h"
#include "tracer/render/pixel_filter.h"

#include <algorithm>

namespace ds {
namespace {

/// Of all pixels.
double total(const FilmSums& sums, std::size_t plane) {
  double sum = 0;
  for (std::size_t tile = 0; tile < sums.tile_spp.size(); ++tile)
    for (const float value : sums.row(tile, plane))
      sum += double{value};
  return sum;
}

std::uint64_t count(const FilmSums& sums, std::size_t plane) {
  return static_cast<std::uint64_t>(total(sums, plane));
}

/// Luminance that scaling outliers down took, over what there would be with it.
double removed_share(const FilmSums& sums) {
  const double removed = total(sums, kernels::k_film_removed);
  if (!(removed > 0)) return 0;
  double kept = 0;
  for (std::size_t q = 0; q < 4; ++q)
    for (std::size_t c = 0; c < 3; ++c)
      kept += k_luminance_weights[c] *
              total(sums, q * kernels::k_film_quarter + kernels::k_film_sum + c);
  return removed / (kept + removed);
}

}  // namespace

PixelRect FilmSums::tile_rect(std::size_t tile) const {
  const std::size_t x = tile % tiles_x() * k_tile_size, y = tile / tiles_x() * k_tile_size;
  return {x, y, std::min(x + k_tile_size, static_cast<std::size_t>(width)),
          std::min(y + k_tile_size, static_cast<std::size_t>(height))};
}

std::size_t FilmSums::tile_pixels(std::size_t tile) const {
  const PixelRect rect = tile_rect(tile);
  return (rect.x1 - rect.x0) * (rect.y1 - rect.y0);
}

std::uint64_t FilmSums::samples() const {
  std::uint64_t sum = 0;
  for (std::size_t tile = 0; tile < tile_spp.size(); ++tile)
    sum += std::uint64_t{tile_spp[tile]} * tile_pixels(tile);
  return sum;
}

std::size_t FilmSums::place(std::size_t x, std::size_t y) const {
  const std::size_t tile = y / k_tile_size * tiles_x() + x / k_tile_size;
  return tile * kernels::k_film_planes * kernels::k_tile_pixels + y % k_tile_size * k_tile_size +
         x % k_tile_size;
}

std::span<const float> FilmSums::row(std::size_t tile, std::size_t plane) const {
  return std::span(planes).subspan((tile * kernels::k_film_planes + plane) * kernels::k_tile_pixels,
                                   kernels::k_tile_pixels);
}

std::span<float> FilmSums::row(std::size_t tile, std::size_t plane) {
  return std::span(planes).subspan((tile * kernels::k_film_planes + plane) * kernels::k_tile_pixels,
                                   kernels::k_tile_pixels);
}

FilmSums empty_film(int width, int height) {
  FilmSums sums;
  sums.width = width;
  sums.height = height;
  sums.tile_spp.assign(sums.tiles_x() * sums.tiles_y(), 0);
  sums.planes.assign(sums.tile_spp.size() * kernels::k_film_planes * kernels::k_tile_pixels, 0.0f);
  return sums;
}

Film film_of(const FilmSums& sums, const PixelFilter& filter) {
  DS_ASSERT(!sums.empty());
  Film film;
  film.width = sums.width;
  film.height = sums.height;
  const auto range = std::minmax_element(sums.tile_spp.begin(), sums.tile_spp.end());
  const std::uint32_t least = *range.first;
  const std::uint32_t most = *range.second;
  DS_ASSERT(least > 0);
  film.rgb.resize(sums.pixels() * 3);
  if (least > 1) film.halves.resize(sums.pixels() * 3);
  const auto w = static_cast<std::size_t>(sums.width), h = static_cast<std::size_t>(sums.height);
  constexpr std::size_t band = 16;  // rows at a time
  parallel_ranges((h + band - 1) / band, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin * band; y < std::min(end * band, h); y += band) {
      std::size_t at = y * w * 3;
      for (const PixelEstimate& pixel : filtered(sums, filter, {0, y, w, std::min(y + band, h)})) {
        std::copy(pixel.mean.begin(), pixel.mean.end(), film.rgb.data() + at);
        if (least > 1) std::copy(pixel.half.begin(), pixel.half.end(), film.halves.data() + at);
        at += 3;
      }
    }
  });
  FilmFacts& facts = film.facts;
  facts.samples = sums.samples();
  facts.least_spp = least;
  facts.most_spp = most;
  facts.nan_samples = count(sums, kernels::k_film_nan);
  facts.infinite_samples = count(sums, kernels::k_film_infinite);
  facts.negative_samples = count(sums, kernels::k_film_negative);
  facts.outlier_samples = count(sums, kernels::k_film_outliers);
  facts.removed_energy = removed_share(sums);
  film.rejected_samples = facts.nan_samples + facts.infinite_samples + facts.negative_samples;
  if (const auto error = luminance_error(film, filter)) {
    film.relative_error = error->value;
    facts.error_low = error->low;
    facts.error_high = error->high;
  }
  return film;
}

}  // namespace ds
