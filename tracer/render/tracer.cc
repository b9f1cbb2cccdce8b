// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/render/film.h"
#include "tracer/render/picture_launches.h"
#include "tracer/render/pixel_filter.h"
#include "tracer/render/render.h"
#include "tracer/render/schedule.h"
#include "tracer/render/tracer_state.h"

#include <algorithm>

namespace ds {
namespace {

/// Whether tracing on from a kept film gives the bits of one go.
bool goes_on(const EngineSettings& engine, const FilmSums& film) {
  if (film.empty() || film.width != engine.width || film.height != engine.height) return false;
  if (engine.target) return Schedule::comes_by(*engine.target, film);
  const auto [least, most] = std::minmax_element(film.tile_spp.begin(), film.tile_spp.end());
  return *least == *most && *most <= static_cast<std::uint32_t>(engine.spp) &&
         !film.schedule.tone_scale;
}

}  // namespace

Tracer::Tracer(const TracerOptions& options) : state_(std::make_unique<State>(options)) {}
Tracer::~Tracer() = default;

std::string Tracer::device_name() const {
  return state_->device.info().name;
}

bool Tracer::runs_on_cpu() const {
  return state_->device.info().is_cpu;
}

void ReadySceneDeleter::operator()(ReadyScene* scene) const {
  delete scene;
}

void Tracer::set_scene(Scene scene) {
  state_->forget_scene();
  state_->ready = state_->maker.take(std::move(scene), SceneUse::pictures);
}

ReadyScenePointer Tracer::make_ready(Scene scene, SceneUse use, const EngineSettings& engine) {
  ReadyScenePointer ready(new ReadyScene(state_->maker.take(std::move(scene), use)));
  state_->maker.pack_ahead(*ready);
  if (ready->numbering && ready->numbering->guide) {
    ready->guide_photons = photons_for(engine);
    ready->guide =
        state_->guides.make(ready->scene, *ready->packed, *ready->numbering, ready->guide_photons);
  }
  return ready;
}

void Tracer::set_scene(ReadyScenePointer scene) {
  DS_ASSERT(scene != nullptr);
  state_->forget_scene();
  state_->ready = std::move(*scene);
}

void Tracer::prepare(const Camera& camera, const EngineSettings& engine,
                     const std::vector<const PlaneType*>& light_planes) {
  state_->prepare(camera, engine, light_planes);
}

bool Tracer::prepare_ahead(const Scene& scene, const Camera& camera, const EngineSettings& engine,
                           const std::vector<const PlaneType*>& light_planes) {
  return state_->programs.make_ahead(
      with_light_planes(state_->effects(scene, camera), light_planes), engine.math);
}

ProgramCounts Tracer::programs() const {
  return state_->programs.counts();
}

UploadCounts Tracer::uploads() const {
  return state_->uploads;
}

RayCounts Tracer::ray_counts() const {
  return state_->ray_counts;
}

/// The pixels that the picture's error is of, for Schedule.
std::vector<std::uint8_t> Tracer::error_region(const Camera& camera, const EngineSettings& engine) {
  if (engine.target->region == ErrorRegion::image) return {};
  std::vector<std::uint8_t> mask = trace_geometry(camera, engine.width, engine.height).mask;
  const bool shown = std::any_of(mask.begin(), mask.end(), [](std::uint8_t m) { return m != 0; });
  return shown ? mask : std::vector<std::uint8_t>{};
}

/// Traces what the picture lacks.
Film Tracer::finish(PictureLaunches& picture, const Camera& camera, const EngineSettings& engine,
                    const std::function<void(const TraceProgress&)>& progress) {
  const std::uint64_t before = picture.film().samples();
  const int most = engine.target ? engine.target->max_spp : engine.spp;
  const std::uint64_t total = picture.film().pixels() * static_cast<std::uint64_t>(most) - before;
  const auto trace_steps = [&](const std::vector<TileStep>& steps) {
    const std::uint64_t base = picture.film().samples() - before;
    picture.add(steps, [&](std::uint64_t done) {
      if (progress) progress({base + done, total});
    });
  };
  const PixelFilter filter(engine.filter_width);
  Film film;
  if (engine.target) {
    Schedule schedule(*engine.target, picture.film(), filter, error_region(camera, engine));
    for (auto steps = schedule.next(); !steps.empty(); steps = schedule.next()) {
      trace_steps(steps);
      schedule.traced(steps);
    }
    picture.film().schedule = schedule.state();
    film = film_of(picture.film(), filter);
    const ErrorEstimate error = schedule.error();
    film.facts.developed_error = error.value;
    film.facts.developed_low = error.low;
    film.facts.developed_high = error.high;
    film.facts.capped = error.high > engine.target->error;
  } else {
    trace_steps(steps_to(picture.film(), static_cast<std::uint32_t>(engine.spp)));
    film = film_of(picture.film(), filter);
  }
  film.traced_samples = picture.film().samples() - before;
  return film;
}

Film Tracer::trace(const Camera& camera, const EngineSettings& engine,
                   const std::function<void(const TraceProgress&)>& progress,
                   const std::atomic<bool>* stop, FilmSums* kept) {
  state_->prepare(camera, engine);
  FilmSums begun = kept != nullptr ? std::move(*kept) : FilmSums{};
  if (!goes_on(engine, begun)) begun = empty_film(engine.width, engine.height);
  PictureLaunches picture(*state_, camera, engine, std::move(begun), 0, stop);
  Film film = finish(picture, camera, engine, progress);
  if (kept != nullptr) *kept = std::move(picture.film());
  return film;
}

LitPlanes Tracer::trace_light(const Camera& camera, const EngineSettings& engine,
                              const std::vector<const PlaneType*>& types,
                              const std::function<void(const TraceProgress&)>& progress,
                              const std::atomic<bool>* stop, FilmSums* reached) {
  state_->prepare(camera, engine, types);
  PictureLaunches picture(*state_, camera, engine, empty_film(engine.width, engine.height),
                          types.size(), stop);
  LitPlanes traced;
  traced.film = finish(picture, camera, engine, progress);
  if (!types.empty())
    traced.planes = light_planes_of(types, picture.light_film(), picture.film(),
                                    PixelFilter(engine.filter_width));
  if (reached != nullptr) *reached = std::move(picture.film());
  return traced;
}

}  // namespace ds
