// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/render.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace ds {

inline constexpr int k_tile_size = 8;  ///< pixels a side: what samples are added to

/// A film under way: what more samples can be added to. Pixel sums are planes of width * height
/// floats in the order of kernels/types.h; row 0 is the top.
struct FilmSums {
  int width = 0, height = 0;
  std::vector<std::uint32_t> tile_spp;  ///< samples each pixel of a tile has; tiles row by row
  std::vector<float> planes;

  bool empty() const { return tile_spp.empty(); }
  std::size_t tiles_x() const { return tiles_along(width); }
  std::size_t tiles_y() const { return tiles_along(height); }
  std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  std::span<const float> plane(int number) const {
    return std::span(planes).subspan(static_cast<std::size_t>(number) * pixels(), pixels());
  }
  std::uint32_t spp_at(std::size_t x, std::size_t y) const {
    return tile_spp[y / k_tile_size * tiles_x() + x / k_tile_size];
  }
  /// Pixels of a tile that lie in the film.
  std::size_t tile_pixels(std::size_t tile) const;
  /// Camera samples taken so far.
  std::uint64_t samples() const;

  static std::size_t tiles_along(int pixels) {
    return (static_cast<std::size_t>(pixels) + k_tile_size - 1) / k_tile_size;
  }
};

/// Without samples, all zero.
FilmSums empty_film(int width, int height);

/// Means, counts and error estimates. Every tile has at least one sample.
Film film_of(const FilmSums& sums);

}  // namespace ds
