// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/develop.h"
#include "tracer/render/film.h"
#include "tracer/render/film_error.h"
#include "tracer/render/pixel_filter.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace ds {

/// More samples for one tile: from the number it has to this one.
struct TileStep {
  std::size_t tile;
  std::uint32_t end;
};

/// Every tile of the film to this number of samples a pixel; the tiles have fewer or as many.
std::vector<TileStep> steps_to(const FilmSums& film, std::uint32_t spp);

/// Which tiles of a picture get more samples until it is as exact as wanted (ErrorTarget).
///
/// Its steps are a pure function of the film, and know neither the error wanted nor max_spp: these
/// only end them. So a film that was ended sooner is a film under way, and going on from it gives
/// the bits of one go.
///
/// A pixel's developed error is estimated from its halves: with m the pixel, h half their
/// difference and D the tone curve, d^2 = ((D(m + h) - D(m))^2 + (D(m - h) - D(m))^2) / 2, summed
/// over r, g, b. film_error.h says why, and what interval that has. The picture's error is
/// sqrt(mean d^2) / mean D(m) over all pixels and channels. D is before rounding to 8 bits, its
/// scale the one the tone map finds after the first step. With a region "all pixels" are its own,
/// and tiles that serve none of them keep what the first step gives.
///
/// First every pixel gets k_first_spp. Then, time and again, the tiles of greatest gain are
/// doubled, until they have taken 1 / k_batch of the samples so far. With errors that fall as 1 / n
/// the gain of a sample is w / n^2, w = n * mean d^2 of a tile: so each tile gets samples in
/// proportion to sqrt(w), which is the least error for the samples there are. This d is of the mean
/// of the pixel's own samples, as what a tile's samples do is wanted here, and weighs as much as
/// the region's pixels have their error from that pixel. Doubling keeps the
/// halves powers of two, where Sobol' points are best.
///
/// A tile that has by chance met little of its light looks exact; were it left so, pictures would
/// be too dark. Hence k_first_spp, and w is to a quarter that of the eight tiles around. What is
/// left of this bias is measured in tests/render/schedule_test.cc.
class Schedule {
 public:
  static constexpr std::uint32_t k_first_spp = 16;
  static constexpr std::uint64_t k_batch = 16;

  /// The film must outlive this. One with samples must be of a Schedule for the same tone map and
  /// region. `region`: not 0 where a pixel belongs to it, one at least; empty: all do.
  Schedule(const ErrorTarget& target, const FilmSums& film, const PixelFilter& filter,
           const std::vector<std::uint8_t>& region = {});

  /// What to trace next; nothing once the error is reached or the next step would pass max_spp.
  std::vector<TileStep> next();
  /// Takes in these steps, whose samples are in the film now.
  void traced(const std::vector<TileStep>& steps);

  ErrorEstimate error() const;
  /// For FilmSums::schedule.
  const ScheduleState& state() const { return state_; }

  /// Whether this target's steps come by the film, so that going on from it is the same as one go.
  static bool comes_by(const ErrorTarget& target, const FilmSums& film);

 private:
  struct Tile {
    ErrorSum error;          ///< of the region's pixels
    double developed = 0;    ///< sum of D(m) over them and the channels
    std::size_t pixels = 0;  ///< of the region
    double own = 0;          ///< sum of d^2 of the pixels' own means, each times its weight
    double weight = 0;       ///< sum of the pixels' weights
  };
  /// `stepped`: tiles with new samples; `stale`: those whose pixels' filters reach into one.
  void measure(const std::vector<std::size_t>& stepped, const std::vector<std::size_t>& stale);
  void measure_error(std::size_t number);
  void measure_own(std::size_t number);
  double sample_variance(std::size_t tile) const;
  double gain(std::size_t tile) const;
  std::vector<TileStep> greatest_gains() const;

  ErrorTarget target_;
  const FilmSums& film_;
  PixelFilter filter_, own_;  ///< own_: a pixel's own samples
  std::vector<std::uint8_t> region_;
  std::vector<float> weights_;  ///< of pixels, see above; empty: 1
  ScheduleState state_;
  std::optional<ToneCurve> curve_;
  std::vector<Tile> tiles_;
};

}  // namespace ds
