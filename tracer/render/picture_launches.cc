// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/picture_launches.h"

#include "tracer/base/error.h"
#include "tracer/kernels/layout.h"

#include <algorithm>
#include <chrono>

namespace ds {
namespace {

using Clock = std::chrono::steady_clock;

/// What the kernel reads of a launch (kernels/film_data.h).
std::vector<std::uint32_t> launch_words(const FilmSums& film, std::span<const TileStep> steps,
                                        std::size_t share) {
  std::vector<std::uint32_t> words{static_cast<std::uint32_t>(share),
                                   static_cast<std::uint32_t>(steps.size())};
  for (const TileStep& step : steps) {
    words.push_back(static_cast<std::uint32_t>(step.tile));
    words.push_back(film.tile_spp[step.tile]);
    words.push_back(step.end);
  }
  return words;
}

}  // namespace

/// How many pixels a work-item takes, if the options leave it open: on a CPU as many as leave eight
/// work-items for each processor, up to eight tiles: lanes idle only when no pixel is left for
/// them. Fewer where pixels have thousands of samples, which keep lanes busy by themselves: a
/// launch is to end soon after it is to stop. A GPU has threads for all.
std::size_t Tracer::PictureLaunches::share_of(std::span<const TileStep> steps) const {
  if (s_.options.item_pixels > 0) return static_cast<std::size_t>(s_.options.item_pixels);
  if (!s_.device.info().is_cpu) return static_cast<std::size_t>(s_.lanes);
  constexpr std::size_t most_samples = 4096;  // of a pixel of each tile
  std::size_t most_spp = 1;
  for (const TileStep& step : steps)
    most_spp = std::max<std::size_t>(most_spp, step.end - film_.tile_spp[step.tile]);
  const std::size_t items = 8 * std::max<std::size_t>(s_.device.info().compute_units, 1);
  const std::size_t tiles =
      std::min({steps.size() / items, most_samples / most_spp, std::size_t{8}});
  return std::max<std::size_t>(tiles, 1) * kernels::k_tile_pixels;
}

/// Work-items from `begin` on that take about half a second, or some for each processor where
/// nothing is known of their time yet.
Tracer::PictureLaunches::Launch Tracer::PictureLaunches::next_launch(
    std::span<const TileStep> steps, std::size_t share, std::size_t begin,
    std::size_t items) const {
  const std::size_t least =
      s_.local_size * std::max<std::size_t>(s_.device.info().compute_units, 1) * 8;
  const double wanted = 0.5 * samples_a_second_;
  Launch launch;
  while (begin + launch.items < items &&
         (launch.items < least || static_cast<double>(launch.samples) < wanted)) {
    const std::size_t first = (begin + launch.items) * share;
    launch.items += s_.local_size;
    const std::size_t last = (begin + launch.items) * share;
    for (std::size_t i = first; i < std::min(last, steps.size() * kernels::k_tile_pixels); ++i) {
      const TileStep& step = steps[i / kernels::k_tile_pixels];
      launch.samples += step.end - film_.tile_spp[step.tile];
    }
  }
  return launch;
}

void Tracer::PictureLaunches::add(std::span<const TileStep> steps,
                                  const std::function<void(std::uint64_t)>& progress) {
  if (steps.empty()) return;
  const std::size_t share = share_of(steps);
  const std::size_t pixels = steps.size() * kernels::k_tile_pixels;
  const std::size_t items = round_up((pixels + share - 1) / share, s_.local_size);
  const Buffer words = s_.device.upload(launch_words(film_, steps, share));
  s_.path_kernel.set(launch_argument_, words);
  s_.start_counting(counts_argument_, items);
  std::uint64_t samples = 0;
  for (const TileStep& step : steps)
    samples += std::uint64_t{step.end - film_.tile_spp[step.tile]} * film_.tile_pixels(step.tile);
  for (std::size_t begin = 0; begin < items;) {
    if (stop_ != nullptr && stop_->load()) fail(ErrorKind::cancelled, "stopped");
    const Launch launch = next_launch(steps, share, begin, items);
    const auto before = Clock::now();
    if (lit_) s_.device.run(s_.path_kernel, begin, launch.items, s_.local_size);
    const std::chrono::duration<double> seconds = Clock::now() - before;
    samples_a_second_ = static_cast<double>(launch.samples) / std::max(seconds.count(), 1e-4);
    begin += launch.items;
    progress(samples * begin / items);
  }
  s_.add_counts();
  s_.device.read(sums_, std::as_writable_bytes(std::span(film_.planes)));
  for (const TileStep& step : steps)
    film_.tile_spp[step.tile] = step.end;
}

}  // namespace ds
