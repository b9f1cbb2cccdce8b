// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/schedule.h"

#include "tracer/base/error.h"

#include <algorithm>
#include <array>
#include <utility>

namespace ds {
namespace {

/// A float counts no further.
constexpr std::uint32_t k_most_spp = std::uint32_t{1} << 24;

std::uint64_t samples_of(const FilmSums& film, const std::vector<TileStep>& steps) {
  std::uint64_t samples = 0;
  for (const TileStep& step : steps)
    samples += std::uint64_t{step.end - film.tile_spp[step.tile]} * film.tile_pixels(step.tile);
  return samples;
}

std::uint64_t most_samples(const ErrorTarget& target, const FilmSums& film) {
  return static_cast<std::uint64_t>(target.max_spp) * film.pixels();
}

}  // namespace

std::vector<TileStep> steps_to(const FilmSums& film, std::uint32_t spp) {
  std::vector<TileStep> steps;
  for (std::size_t tile = 0; tile < film.tile_spp.size(); ++tile) {
    DS_ASSERT(film.tile_spp[tile] <= spp);
    if (film.tile_spp[tile] < spp) steps.push_back({tile, spp});
  }
  return steps;
}

Schedule::Schedule(const ErrorTarget& target, const FilmSums& film,
                   std::vector<std::uint8_t> region)
    : target_(target),
      film_(film),
      region_(std::move(region)),
      state_(film.schedule),
      tiles_(film.tile_spp.size()) {
  DS_ASSERT(region_.empty() || region_.size() == film.pixels());
  DS_ASSERT(target.error > 0 && target.max_spp >= static_cast<int>(k_first_spp));
  if (film.samples() == 0) return;
  DS_ASSERT(state_.tone_scale.has_value());
  curve_.emplace(target.tone_map, *state_.tone_scale);
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile)
    measure(tile);
}

void Schedule::measure(std::size_t number) {
  Tile tile;
  film_.visit_tile(number, [&](std::size_t pixel) {
    if (!region_.empty() && region_[pixel] == 0) return;
    ++tile.pixels;
    const PixelEstimate p = pixel_of(film_, pixel, film_.tile_spp[number]);
    std::array<float, 3> more{}, less{};
    for (std::size_t c = 0; c < 3; ++c) {
      more[c] = p.mean[c] + p.half[c];
      less[c] = p.mean[c] - p.half[c];
    }
    const auto here = curve_->at(p.mean), above = curve_->at(more), below = curve_->at(less);
    double squared = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double up = above[c] - here[c], down = below[c] - here[c];
      squared += (up * up + down * down) / 2;
      tile.developed += here[c];
    }
    tile.error.add(squared);
  });
  tiles_[number] = tile;
}

/// w of a pixel: what its squared error would be with one sample.
double Schedule::sample_variance(std::size_t tile) const {
  return tiles_[tile].error.sum() * film_.tile_spp[tile] /
         static_cast<double>(film_.tile_pixels(tile));
}

double Schedule::gain(std::size_t tile) const {
  const std::size_t columns = film_.tiles_x(), rows = film_.tiles_y();
  const std::size_t x = tile % columns, y = tile / columns;
  double around = 0;
  int count = 0;
  for (std::size_t v = y > 0 ? y - 1 : 0; v < std::min(y + 2, rows); ++v)
    for (std::size_t u = x > 0 ? x - 1 : 0; u < std::min(x + 2, columns); ++u) {
      if ((u == x && v == y) || tiles_[v * columns + u].pixels == 0) continue;
      around += sample_variance(v * columns + u);
      ++count;
    }
  const double own = sample_variance(tile);
  const double w = count > 0 ? 0.75 * own + 0.25 * around / count : own;
  const double n = film_.tile_spp[tile];
  return w / (n * n);
}

std::vector<TileStep> Schedule::greatest_gains() const {
  std::vector<std::pair<double, std::size_t>> gains;
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile)
    if (tiles_[tile].pixels > 0 && film_.tile_spp[tile] < k_most_spp)
      gains.emplace_back(gain(tile), tile);
  std::sort(gains.begin(), gains.end(), [](const auto& a, const auto& b) {
    return a.first > b.first || (a.first == b.first && a.second < b.second);
  });
  std::vector<TileStep> steps;
  const std::uint64_t batch = film_.samples() / k_batch;
  std::uint64_t taken = 0;
  for (const auto& [gained, tile] : gains) {
    if (taken >= batch && !steps.empty()) break;
    steps.push_back({tile, film_.tile_spp[tile] * 2});
    taken += std::uint64_t{film_.tile_spp[tile]} * film_.tile_pixels(tile);
  }
  return steps;
}

std::vector<TileStep> Schedule::next() {
  if (film_.samples() == 0) return steps_to(film_, k_first_spp);
  const double bound = error().high;
  if (bound <= target_.error) return {};
  std::vector<TileStep> steps = greatest_gains();
  if (film_.samples() + samples_of(film_, steps) > most_samples(target_, film_)) return {};
  state_.least_bound = std::min(state_.least_bound, bound);
  return steps;
}

void Schedule::traced(const std::vector<TileStep>& steps) {
  if (!curve_) {
    state_.tone_scale = tone_map_scale(film_of(film_), target_.tone_map);
    curve_.emplace(target_.tone_map, *state_.tone_scale);
  }
  for (const TileStep& step : steps)
    measure(step.tile);
}

ErrorEstimate Schedule::error() const {
  ErrorSum sum;
  double developed = 0;
  std::size_t pixels = 0;
  for (const Tile& tile : tiles_) {
    sum += tile.error;
    developed += tile.developed;
    pixels += tile.pixels;
  }
  const double values = 3 * static_cast<double>(pixels);
  return sum.estimate(developed / values, values);
}

bool Schedule::comes_by(const ErrorTarget& target, const FilmSums& film) {
  return film.schedule.tone_scale.has_value() && film.schedule.least_bound > target.error &&
         film.samples() <= most_samples(target, film);
}

}  // namespace ds
