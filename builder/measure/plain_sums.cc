// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/plain_sums.h"

#include "tracer/base/error.h"
#include "tracer/base/luminance.h"
#include "tracer/kernels/layout.h"
#include "tracer/render/film_error.h"

#include <cmath>

namespace ds {
namespace {

/// Luminance of the pixel whose first value is the `i`-th.
template <typename Values>
double pixel_luminance(const Values& values, std::size_t i) {
  double sum = 0;
  for (std::size_t q = 0; q < 4; ++q)
    for (std::size_t c = 0; c < 3; ++c)
      sum += k_luminance_weights[c] * double{values[i + (3 * q + c) * kernels::k_tile_pixels]};
  return sum;
}

}  // namespace

void PlainSums::add(const FilmSums& film) {
  constexpr std::size_t tile_values = std::size_t{4} * 3 * kernels::k_tile_pixels;
  const std::size_t values = film.tile_spp.size() * tile_values;
  if (totals_.empty()) {
    totals_.resize(values);
    plain_.resize(values);
    pixels_ = film.pixels();
  }
  DS_ASSERT(totals_.size() == values);
  std::size_t i = 0;
  for (std::size_t tile = 0; tile < film.tile_spp.size(); ++tile)
    for (std::size_t q = 0; q < 4; ++q)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t plane = q * kernels::k_film_quarter + c;
        const auto sums = film.row(tile, plane + kernels::k_film_sum);
        const auto rest = film.row(tile, plane + kernels::k_film_compensation);
        for (std::size_t k = 0; k < sums.size(); ++k, ++i) {
          const double total = double{sums[k]} + double{rest[k]};
          plain_[i] += static_cast<float>(total - totals_[i]);
          totals_[i] = total;
        }
      }
}

double PlainSums::relative_error() const {
  double squares = 0, luminance = 0;
  for (std::size_t tile = 0; tile < totals_.size();
       tile += std::size_t{12} * kernels::k_tile_pixels)
    for (std::size_t k = 0; k < kernels::k_tile_pixels; ++k) {
      const double whole = pixel_luminance(totals_, tile + k);
      const double off = pixel_luminance(plain_, tile + k) - whole;
      squares += off * off;
      luminance += whole;
    }
  if (!(luminance > 0)) return 0;
  const auto pixels = static_cast<double>(pixels_);
  return std::sqrt(squares / pixels) / (luminance / pixels);
}

}  // namespace ds
