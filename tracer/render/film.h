// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/render.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ds {

inline constexpr int k_tile_size = 4;  ///< pixels a side: what samples are added to

/// What a Schedule must remember of a film beside its samples.
struct ScheduleState {
  std::optional<double> tone_scale;  ///< of the tone map after the first step; none before, and
                                     ///< where no Schedule made the film
  /// Least upper end of the error's interval that the film had before its last step: for a larger
  /// error wanted it would have been ended sooner.
  double least_bound = std::numeric_limits<double>::infinity();

  bool operator==(const ScheduleState&) const = default;
};

/// A film under way: what more samples can be added to. Pixel sums are planes of width * height
/// floats in the order of kernels/types.h; row 0 is the top.
struct FilmSums {
  int width = 0, height = 0;
  std::vector<std::uint32_t> tile_spp;  ///< samples each pixel of a tile has; tiles row by row
  std::vector<float> planes;
  ScheduleState schedule;

  bool empty() const { return tile_spp.empty(); }
  std::size_t tiles_x() const { return tiles_along(width); }
  std::size_t tiles_y() const { return tiles_along(height); }
  std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  std::span<const float> plane(int number) const {
    return std::span(planes).subspan(static_cast<std::size_t>(number) * pixels(), pixels());
  }
  /// Pixels of a tile that lie in the film.
  std::size_t tile_pixels(std::size_t tile) const;
  /// Calls `visit` with the number (y * width + x) of each of them.
  template <typename Visit>
  void visit_tile(std::size_t tile, const Visit& visit) const {
    const std::size_t x0 = tile % tiles_x() * k_tile_size, y0 = tile / tiles_x() * k_tile_size;
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    for (std::size_t y = y0; y < std::min(y0 + k_tile_size, h); ++y)
      for (std::size_t x = x0; x < std::min(x0 + k_tile_size, w); ++x)
        visit(y * w + x);
  }
  /// Camera samples taken so far.
  std::uint64_t samples() const;

  static std::size_t tiles_along(int pixels) {
    return (static_cast<std::size_t>(pixels) + k_tile_size - 1) / k_tile_size;
  }
};

/// Without samples, all zero.
FilmSums empty_film(int width, int height);

/// A pixel's mean, and half the difference between the means of its even and odd samples (zero for
/// a single sample).
struct PixelEstimate {
  std::array<float, 3> mean{}, half{};
};
PixelEstimate pixel_of(const FilmSums& film, std::size_t pixel, std::uint32_t spp);

/// Means, counts and error estimates. Every tile has at least one sample.
Film film_of(const FilmSums& sums);

}  // namespace ds
