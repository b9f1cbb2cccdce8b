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

struct PixelRect {
  std::size_t x0, y0, x1, y1;  ///< x1 and y1 lie behind the last
};

/// A film under way: what more samples can be added to. `planes` has the layout of kernels/film_data.h.
/// Tiles stand row by row, row 0 is the top.
struct FilmSums {
  int width = 0, height = 0;
  std::vector<std::uint32_t> tile_spp;  ///< samples each pixel of a tile has
  std::vector<float> planes;
  ScheduleState schedule;

  bool empty() const { return tile_spp.empty(); }
  std::size_t tiles_x() const { return tiles_along(width); }
  std::size_t tiles_y() const { return tiles_along(height); }
  std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  /// Where plane 0 of a pixel stands in `planes`; the others follow, one every tile's pixels.
  std::size_t place(std::size_t x, std::size_t y) const;
  /// A tile's values of a plane, pixel by pixel.
  std::span<const float> row(std::size_t tile, std::size_t plane) const;
  std::span<float> row(std::size_t tile, std::size_t plane);
  /// Pixels of a tile that lie in the film.
  PixelRect tile_rect(std::size_t tile) const;
  std::size_t tile_pixels(std::size_t tile) const;
  /// Camera samples taken so far.
  std::uint64_t samples() const;

  static std::size_t tiles_along(int pixels) {
    return (static_cast<std::size_t>(pixels) + k_tile_size - 1) / k_tile_size;
  }
};

/// Without samples, all zero.
FilmSums empty_film(int width, int height);

/// A pixel's mean, and half the difference between the means of its even and odd samples (zero
/// where it has none of either).
struct PixelEstimate {
  std::array<float, 3> mean{}, half{};
};

class PixelFilter;
/// The picture, counts and error estimates. Every tile has at least one sample.
Film film_of(const FilmSums& sums, const PixelFilter& filter);

}  // namespace ds
