// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/schedule.h"

#include "tracer/base/error.h"
#include "tracer/base/parallel.h"

#include <algorithm>
#include <array>
#include <numeric>
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

/// Calls visit(i, x, y) for the pixels of a rectangle row by row, the i-th being (x, y).
template <typename Visit>
void visit_pixels(const PixelRect& rect, const Visit& visit) {
  std::size_t i = 0;
  for (std::size_t y = rect.y0; y < rect.y1; ++y)
    for (std::size_t x = rect.x0; x < rect.x1; ++x)
      visit(i++, x, y);
}

struct DevelopedPixel {
  double sum = 0;      ///< of D(m) over r, g, b
  double squared = 0;  ///< d^2
};

DevelopedPixel developed_pixel(const ToneCurve& curve, const PixelEstimate& p) {
  std::array<float, 3> more{}, less{};
  for (std::size_t c = 0; c < 3; ++c) {
    more[c] = p.mean[c] + p.half[c];
    less[c] = p.mean[c] - p.half[c];
  }
  const auto here = curve.at(p.mean), above = curve.at(more), below = curve.at(less);
  DevelopedPixel pixel;
  for (std::size_t c = 0; c < 3; ++c) {
    const double up = above[c] - here[c], down = below[c] - here[c];
    pixel.squared += (up * up + down * down) / 2;
    pixel.sum += here[c];
  }
  return pixel;
}

/// For each pixel what the region's pixels have of their variance from it, all summed up.
std::vector<float> weights_of(const FilmSums& film, const PixelFilter& filter,
                              const std::vector<std::uint8_t>& region) {
  const auto w = static_cast<std::size_t>(film.width), h = static_cast<std::size_t>(film.height);
  const std::size_t reach = filter.reach();
  const std::span<const double> shares = filter.shares();
  std::vector<float> weights(film.pixels(), 0.0f);
  visit_pixels({0, 0, w, h}, [&](std::size_t pixel, std::size_t x, std::size_t y) {
    if (region[pixel] == 0) return;
    for (std::size_t v = y - std::min(y, reach); v < std::min(y + reach + 1, h); ++v)
      for (std::size_t u = x - std::min(x, reach); u < std::min(x + reach + 1, w); ++u)
        weights[v * w + u] += static_cast<float>(shares[u + reach - x] * shares[v + reach - y]);
  });
  return weights;
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

Schedule::Schedule(const ErrorTarget& target, const FilmSums& film, const PixelFilter& filter,
                   const std::vector<std::uint8_t>& region)
    : target_(target),
      film_(film),
      filter_(filter),
      own_(0),
      region_(region),
      weights_(region.empty() ? std::vector<float>{} : weights_of(film, filter, region)),
      state_(film.schedule),
      tiles_(film.tile_spp.size()) {
  DS_ASSERT(region_.empty() || region_.size() == film.pixels());
  DS_ASSERT(target.error > 0 && target.max_spp >= static_cast<int>(k_first_spp));
  if (film.samples() == 0) return;
  DS_ASSERT(state_.tone_scale.has_value());
  curve_.emplace(target.tone_map, *state_.tone_scale);
  std::vector<std::size_t> all(tiles_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  measure(all, all);
}

void Schedule::measure(const std::vector<std::size_t>& stepped,
                       const std::vector<std::size_t>& stale) {
  constexpr std::size_t least = 8;  // tiles a thread, some 100 microseconds
  parallel_ranges(stepped.size(), least, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      measure_own(stepped[i]);
  });
  parallel_ranges(stale.size(), least, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      measure_error(stale[i]);
  });
}

void Schedule::measure_error(std::size_t number) {
  Tile& tile = tiles_[number];
  tile.error = {};
  tile.developed = 0;
  tile.pixels = 0;
  const PixelRect rect = film_.tile_rect(number);
  const std::vector<PixelEstimate> pixels = filtered(film_, filter_, rect);
  visit_pixels(rect, [&](std::size_t i, std::size_t x, std::size_t y) {
    if (!region_.empty() && region_[y * static_cast<std::size_t>(film_.width) + x] == 0) return;
    const DevelopedPixel developed = developed_pixel(*curve_, pixels[i]);
    tile.error.add(developed.squared);
    tile.developed += developed.sum;
    ++tile.pixels;
  });
}

void Schedule::measure_own(std::size_t number) {
  Tile& tile = tiles_[number];
  tile.own = tile.weight = 0;
  const PixelRect rect = film_.tile_rect(number);
  const std::vector<PixelEstimate> pixels = filtered(film_, own_, rect);
  visit_pixels(rect, [&](std::size_t i, std::size_t x, std::size_t y) {
    const double weight =
        weights_.empty() ? 1.0 : double{weights_[y * static_cast<std::size_t>(film_.width) + x]};
    if (!(weight > 0)) return;
    tile.own += weight * developed_pixel(*curve_, pixels[i]).squared;
    tile.weight += weight;
  });
}

/// w of a pixel: what its squared error would be with one sample.
double Schedule::sample_variance(std::size_t tile) const {
  return tiles_[tile].own * film_.tile_spp[tile] / static_cast<double>(film_.tile_pixels(tile));
}

double Schedule::gain(std::size_t tile) const {
  const std::size_t columns = film_.tiles_x(), rows = film_.tiles_y();
  const std::size_t x = tile % columns, y = tile / columns;
  double around = 0;
  int count = 0;
  for (std::size_t v = y > 0 ? y - 1 : 0; v < std::min(y + 2, rows); ++v)
    for (std::size_t u = x > 0 ? x - 1 : 0; u < std::min(x + 2, columns); ++u) {
      if ((u == x && v == y) || !(tiles_[v * columns + u].weight > 0)) continue;
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
    if (tiles_[tile].weight > 0 && film_.tile_spp[tile] < k_most_spp)
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
    state_.tone_scale = tone_map_scale(film_of(film_, filter_), target_.tone_map);
    curve_.emplace(target_.tone_map, *state_.tone_scale);
  }
  std::vector<bool> is_stale(tiles_.size(), false);
  std::vector<std::size_t> stepped, stale;
  const std::size_t reach = (filter_.reach() + k_tile_size - 1) / k_tile_size;
  const std::size_t columns = film_.tiles_x(), rows = film_.tiles_y();
  for (const TileStep& step : steps) {
    stepped.push_back(step.tile);
    const std::size_t x = step.tile % columns, y = step.tile / columns;
    for (std::size_t v = y - std::min(y, reach); v < std::min(y + reach + 1, rows); ++v)
      for (std::size_t u = x - std::min(x, reach); u < std::min(x + reach + 1, columns); ++u)
        is_stale[v * columns + u] = true;
  }
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile)
    if (is_stale[tile]) stale.push_back(tile);
  measure(stepped, stale);
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
  return sum.estimate(developed / values, values, filter_.correlation());
}

bool Schedule::comes_by(const ErrorTarget& target, const FilmSums& film) {
  return film.schedule.tone_scale.has_value() && film.schedule.least_bound > target.error &&
         film.samples() <= most_samples(target, film);
}

}  // namespace ds
