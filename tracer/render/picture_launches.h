// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/film.h"
#include "tracer/render/light_planes.h"
#include "tracer/render/schedule.h"
#include "tracer/render/tracer_state.h"
#include "tracer/render/view.h"

#include <functional>
#include <span>

namespace ds {

/// One picture under way: its film on the device, and how it gets more samples.
class Tracer::PictureLaunches {
 public:
  /// `light_planes`: how many the program traces beside it; then the film must be empty.
  PictureLaunches(State& state, const Camera& camera, const EngineSettings& engine, FilmSums film,
                  std::size_t light_planes, const std::atomic<bool>* stop)
      : s_(state), film_(std::move(film)), stop_(stop) {
    const kernels::ViewData view =
        view_data(camera, engine, ray_start_m(s_.scene(), camera, engine.width, engine.height));
    view_ = s_.device.upload(std::as_bytes(std::span(&view, 1)));
    sums_ = s_.device.upload(film_.planes);
    const DeviceScene& t = s_.device_scene;
    unsigned argument = 0;
    const Buffer &v = view_, &guide = s_.guide;
    for (const Buffer* b : {&t.nodes, &t.leaves, &t.triangles, &t.materials, &t.texture_code,
                            &t.lights, &t.tables, &t.data, &guide, &v})
      s_.path_kernel.set(argument++, *b);
    launch_argument_ = argument;
    s_.path_kernel.set(++argument, sums_);
    light_words_ = light_film_words(film_, light_planes);
    if (light_words_ > 0) {
      light_sums_ = s_.device.upload(std::vector<float>(light_words_));
      s_.path_kernel.set(++argument, light_sums_);
    }
    counts_argument_ = argument + 1;
    lit_ = s_.is_lit(camera);
  }

  FilmSums& film() { return film_; }
  /// Words of the planes' film as it stands.
  std::vector<float> light_film() const {
    std::vector<float> words(light_words_);
    s_.device.read(light_sums_, std::as_writable_bytes(std::span(words)));
    return words;
  }

  /// Traces the steps in launches of about half a second: often enough to report and to stop.
  /// `progress` gets the samples done of these steps.
  void add(std::span<const TileStep> steps, const std::function<void(std::uint64_t)>& progress);

 private:
  struct Launch {
    std::size_t items = 0;
    std::uint64_t samples = 0;
  };
  std::size_t share_of(std::span<const TileStep> steps) const;
  Launch next_launch(std::span<const TileStep> steps, std::size_t share, std::size_t begin,
                     std::size_t items) const;

  State& s_;
  FilmSums film_;
  const std::atomic<bool>* stop_;
  Buffer view_, sums_, light_sums_;
  std::size_t light_words_ = 0;
  unsigned launch_argument_ = 0, counts_argument_ = 0;
  bool lit_ = true;
  double samples_a_second_ = 0;  ///< of the last launch
};

}  // namespace ds
