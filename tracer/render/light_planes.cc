// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/light_planes.h"

#include "tracer/base/error.h"
#include "tracer/base/parallel.h"
#include "tracer/kernels/layout.h"

#include <algorithm>

namespace ds {
namespace {

/// Puts a plane's sums where the picture has its own.
void take_sums(FilmSums& film, std::span<const float> words, std::size_t planes,
               std::size_t number) {
  const std::size_t rows = planes * kernels::k_light_plane;
  for (std::size_t tile = 0; tile < film.tile_spp.size(); ++tile)
    for (std::size_t q = 0; q < 4; ++q)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t to = q * kernels::k_film_quarter + c;
        const std::size_t from = number * kernels::k_light_plane + q * kernels::k_light_quarter + c;
        const auto copy = [&](std::size_t row, std::size_t light_row) {
          const auto source = words.subspan((tile * rows + light_row) * kernels::k_tile_pixels,
                                            kernels::k_tile_pixels);
          std::copy(source.begin(), source.end(), film.row(tile, row).begin());
        };
        copy(to + kernels::k_film_sum, from + kernels::k_light_sum);
        copy(to + kernels::k_film_compensation, from + kernels::k_light_compensation);
      }
}

/// The first `width` numbers of each pixel.
std::vector<float> pixels_of(const FilmSums& film, const PixelFilter& filter, int width) {
  const auto w = static_cast<std::size_t>(film.width), h = static_cast<std::size_t>(film.height);
  const auto numbers = static_cast<std::size_t>(width);
  std::vector<float> values(w * h * numbers);
  constexpr std::size_t band = 16;  // rows at a time
  parallel_ranges((h + band - 1) / band, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin * band; y < std::min(end * band, h); y += band) {
      auto to = values.begin() + static_cast<std::ptrdiff_t>(y * w * numbers);
      for (const PixelEstimate& pixel : filtered(film, filter, {0, y, w, std::min(y + band, h)}))
        to = std::copy_n(pixel.mean.begin(), numbers, to);
    }
  });
  return values;
}

}  // namespace

std::size_t light_film_words(const FilmSums& picture, std::size_t planes) {
  return picture.tile_spp.size() * planes * kernels::k_light_plane * kernels::k_tile_pixels;
}

std::vector<Plane> light_planes_of(const std::vector<const PlaneType*>& types,
                                   std::span<const float> words, FilmSums picture,
                                   const PixelFilter& filter) {
  DS_ASSERT(words.size() == light_film_words(picture, types.size()));
  std::vector<Plane> planes;
  for (std::size_t i = 0; i < types.size(); ++i) {
    take_sums(picture, words, types.size(), i);
    planes.push_back(
        {types[i], picture.width, picture.height, pixels_of(picture, filter, types[i]->width)});
  }
  return planes;
}

}  // namespace ds
