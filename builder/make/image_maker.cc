// SPDX-License-Identifier: Apache-2.0
#include "builder/make/image_maker.h"

#include "builder/make/plane_outputs.h"
#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/device/plane_types.h"
#include "tracer/render/develop.h"
#include "tracer/render/film_file.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace ds {

/// What is known while one image is traced.
struct ImageMaker::Work {
  const PlannedImage& image;
  bool force;
  const std::function<void(const TraceProgress&)>& progress;
  const std::atomic<bool>& stop;
  TracedImage traced;
};

namespace {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

ImageMaker::ImageMaker(Dataset& dataset, Inputs& inputs, const TextSet& texts, Disk& disk,
                       RendererFactory factory, std::optional<Placing> placing)
    : dataset_(dataset),
      inputs_(inputs),
      factory_(std::move(factory)),
      keeper_(dataset, texts, disk, placing) {}

/// What the tracer will be asked of the image.
SceneUse ImageMaker::use_of(const PlannedImage& image) const {
  if (image.traces_paths()) return SceneUse::pictures;
  const std::vector<PlaneOutput>& planes = dataset_.recipe.outputs.planes;
  const bool materials = std::any_of(planes.begin(), planes.end(), [](const PlaneOutput& plane) {
    return reads_materials(*plane.type);
  });
  return materials ? SceneUse::pictures : SceneUse::planes;
}

Renderer& ImageMaker::renderer() {
  if (no_device_) throw *no_device_;
  if (!renderer_) {
    try {
      renderer_ = factory_();
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::device) throw;
      throw no_device_.emplace(error.what());
    }
    renderer_->announce(std::exchange(upcoming_, {}));
  }
  if (const PlannedImage* next = std::exchange(expected_, nullptr))
    renderer_->expect(next->spec, use_of(*next));
  return *renderer_;
}

std::optional<Product> ImageMaker::find_whole(Hash128 key) const {
  std::optional<Product> product = dataset_.database->find_product(key);
  // The row of a lost object stays: files placed of it before are still what it says.
  if (product && !dataset_.store->intact(product->object)) return std::nullopt;
  return product;
}

/// An empty one where none is kept, or it cannot be read: then tracing starts anew.
FilmSums ImageMaker::kept_film(const Work& work) {
  if (work.force || !dataset_.recipe.keep_sums) return {};
  keeper_.wait_for(work.image.keys.kept);
  const std::optional<Product> known = dataset_.database->find_product(work.image.keys.kept);
  const auto bytes = known ? dataset_.store->get(known->object) : std::nullopt;
  if (!bytes) return {};
  try {
    return decode_film_sums(*bytes, "kept film of " + work.image.spec.id);
  } catch (const Error& error) {
    warn(error.what());
    return {};
  }
}

void ImageMaker::trace_film(Work& work) {
  TracedImage& traced = work.traced;
  const Stopwatch watch;
  FilmSums sums = kept_film(work);
  const std::uint64_t had = sums.samples();
  traced.film = renderer().trace(work.image.spec, &sums, work.progress, work.stop);
  traced.new_film = true;
  traced.work.traced = true;
  traced.work.samples += traced.film->traced_samples;
  traced.film_run = {watch.seconds(), renderer().device()};
  // The film with more samples is kept, of the one there was and this one.
  if (dataset_.recipe.keep_sums && !sums.empty() && sums.samples() > had)
    traced.sums = std::move(sums);
}

/// The planes of light, and the film where none is had yet and it has the same bits.
void ImageMaker::trace_light(Work& work) {
  TracedImage& traced = work.traced;
  if (!traced.light_planes.empty()) return;
  const Stopwatch watch;
  FilmSums sums;
  LitPlanes lit =
      renderer().trace_light(work.image.spec, wanted_light_planes(dataset_.recipe.outputs), &sums,
                             work.progress, work.stop);
  traced.light_planes = std::move(lit.planes);
  traced.light_run = {watch.seconds(), renderer().device()};
  traced.work.traced = true;
  traced.work.samples += lit.film.traced_samples;
  if (traced.film || work.image.spec.engine.math != MathMode::strict) return;
  traced.film = std::move(lit.film);
  traced.new_film = true;
  traced.film_run = traced.light_run;
  if (dataset_.recipe.keep_sums) traced.sums = std::move(sums);
}

/// All planes that ask no light, and what is seen of each distractor.
void ImageMaker::trace_planes(Work& work) {
  const ImageSpec& image = work.image.spec;
  std::vector<const PlaneType*> types = planes_of(dataset_.recipe.outputs);
  const PlaneType& ids = plane_type("object_id");
  const bool shows_others = !image.distractors->empty();
  const bool has_ids = std::find(types.begin(), types.end(), &ids) != types.end();
  if (shows_others && !has_ids) types.push_back(&ids);
  std::vector<Plane> planes = renderer().trace_planes(image, types);
  if (shows_others) {
    const auto seen = std::find_if(planes.begin(), planes.end(),
                                   [&](const Plane& plane) { return plane.type == &ids; });
    const std::vector<Plane> alone = renderer().trace_distractors(image);
    for (std::size_t i = 0; i < alone.size(); ++i)
      work.traced.objects.push_back(count_object((*image.distractors)[i].id(), seen->values,
                                                 alone[i].values, seen->width, seen->height));
    if (!has_ids) planes.erase(seen);
  }
  work.traced.planes = std::move(planes);
}

/// Whether a plane of light is to be traced.
bool ImageMaker::lacks_light(const Work& work) {
  return std::any_of(work.image.files.begin(), work.image.files.end(),
                     [&](const PlannedFile& file) {
                       return file.state == FileState::to_make && file.output.plane != nullptr &&
                              is_of_light(*file.output.plane);
                     });
}

void ImageMaker::obtain_film(Work& work) {
  if (lacks_light(work)) trace_light(work);
  if (work.traced.film) return;
  const Hash128 key = work.image.keys.render;
  keeper_.wait_for(key);
  const std::optional<Product> known =
      work.force ? std::nullopt : dataset_.database->find_product(key);
  const auto bytes = known ? dataset_.store->get(known->object) : std::nullopt;
  if (!bytes) return trace_film(work);
  Film film = decode_film_exr(*bytes, "film of " + work.image.spec.id);
  film.rejected_samples = known->rejected_samples;
  film.relative_error = known->relative_error;
  film.facts = known->facts;
  work.traced.film = std::move(film);
}

/// Sees to it that the keeper can make the file.
void ImageMaker::obtain(Work& work, const OutputFile& output) {
  TracedImage& traced = work.traced;
  traced.made_before.push_back(!work.force && keeper_.makes(output.key));
  traced.known.emplace_back();
  if (traced.made_before.back()) return;
  if (!work.force) traced.known.back() = find_whole(output.key);
  if (traced.known.back()) return;
  const bool is_light = output.plane != nullptr && is_of_light(*output.plane);
  if (is_light) trace_light(work);
  if (output.plane == nullptr || is_cut_out(dataset_.recipe.outputs, output)) {
    obtain_film(work);
    traced.tone_map =
        tone_map_of(dataset_.recipe, inputs_.environment(work.image.spec.environment_folder));
  } else if (is_light) {
    return;
  } else if (traced.planes.empty()) {
    const Stopwatch watch;
    trace_planes(work);
    traced.planes_run = {watch.seconds(), renderer().device()};
    traced.work.traced = true;
  }
}

void ImageMaker::start(const PlannedImage& image, bool force,
                       const std::function<void(const TraceProgress&)>& progress,
                       const std::atomic<bool>& stop) {
  Work work{image, force, progress, stop, {}};
  work.traced.image = &image;
  for (const PlannedFile& file : image.files) {
    if (file.state == FileState::in_place) {
      work.traced.known.emplace_back();
      work.traced.made_before.push_back(false);
    } else {
      obtain(work, file.output);
    }
  }
  keeper_.keep(std::move(work.traced));
}

ImageWork ImageMaker::make(const PlannedImage& image, bool force,
                           const std::function<void(const TraceProgress&)>& progress,
                           const std::atomic<bool>& stop) {
  start(image, force, progress, stop);
  keeper_.finish();
  const std::vector<KeptImage> kept = keeper_.take();
  DS_ASSERT(kept.size() == 1);
  if (kept.front().error) std::rethrow_exception(kept.front().error);
  return kept.front().work;
}

}  // namespace ds
