// SPDX-License-Identifier: Apache-2.0
#include "builder/make/plane_outputs.h"
#include "builder/make/renderer.h"
#include "builder/make/scene_ahead.h"
#include "builder/plan/image_material.h"
#include "builder/plan/image_parts.h"
#include "builder/plan/image_scene.h"
#include "builder/plan/keys.h"
#include "tracer/base/error.h"
#include "tracer/device/plane_types.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/told_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

namespace ds {
namespace {

class TracerRenderer : public Renderer {
 public:
  TracerRenderer(Inputs& inputs, const Recipe& recipe, const TracerOptions& options)
      : inputs_(inputs), recipe_(recipe), tracer_(options) {}

  Film trace(const ImageSpec& image, FilmSums* kept,
             const std::function<void(const TraceProgress&)>& progress,
             const std::atomic<bool>& stop) override {
    load(image, SceneUse::pictures);
    tracer_.prepare(image.camera, image.engine);
    prepare_next();
    return tracer_.trace(image.camera, image.engine, progress, &stop, kept);
  }
  LitPlanes trace_light(const ImageSpec& image, const std::vector<const PlaneType*>& types,
                        FilmSums* reached,
                        const std::function<void(const TraceProgress&)>& progress,
                        const std::atomic<bool>& stop) override {
    load(image, SceneUse::pictures);
    tracer_.prepare(image.camera, image.engine, types);
    prepare_next();
    return tracer_.trace_light(image.camera, image.engine, types, progress, &stop, reached);
  }
  std::vector<Plane> trace_planes(const ImageSpec& image,
                                  const std::vector<const PlaneType*>& types) override {
    const bool materials = std::any_of(
        types.begin(), types.end(), [](const PlaneType* type) { return reads_materials(*type); });
    load(image, materials ? SceneUse::pictures : SceneUse::planes);
    return tracer_.trace_planes(image.camera, image.engine.width, image.engine.height, types);
  }
  std::vector<Plane> trace_distractors(const ImageSpec& image) override {
    load(image, SceneUse::planes);
    std::vector<std::uint32_t> ids;
    for (const Distractor& one : *image.distractors)
      ids.push_back(one.id());
    return tracer_.trace_alone(image.camera, image.engine.width, image.engine.height, ids);
  }
  void expect(const ImageSpec& image, SceneUse use) override { expected_ = Expected{&image, use}; }
  void announce(std::vector<const ImageSpec*> images) override {
    upcoming_.assign(images.begin(), images.end());
  }
  ProgramCounts programs() const override { return tracer_.programs(); }
  std::string device() const override { return tracer_.device_name(); }

 private:
  struct Expected {
    const ImageSpec* image;
    SceneUse use;
  };
  std::string name_of(const ImageSpec& image) const {
    return fmt::format(
        "{}\n{}\n{}\n{}{}{}{}{}", image.model_file->native(), image.material_file->native(),
        image.environment_folder->native(), canonical_change(change_of(image, recipe_, inputs_)),
        canonical_lights(image.lights), canonical_model({}, {}, normalise_of(image, recipe_)),
        canonical_vary(image, recipe_), name_of_distractors(image));
  }

  std::string name_of_distractors(const ImageSpec& image) const {
    std::string text;
    for (const Distractor& one : *image.distractors)
      text += fmt::format(
          "{}\n{}\n{}\n{}{}", one.number, one.model.file->native(), one.material_file->native(),
          canonical_model({}, {}, normalise_of(one, recipe_)), canonical_vary(one, recipe_));
    return text;
  }

  void load(const ImageSpec& image, SceneUse use) {
    const std::string wanted = name_of(image);
    if (loaded_ != wanted) {
      loaded_.clear();  // a scene that fails half way is not the one before
      ReadyScenePointer scene = ahead_.take(wanted);
      if (!scene) scene = source_of(image, use)();
      tracer_.set_scene(std::move(scene));
      loaded_ = wanted;
    }
    if (const auto next = std::exchange(expected_, std::nullopt)) start_ahead(*next);
  }

  void start_ahead(const Expected& next) {
    // Of a model that takes gigabytes no second one is held.
    constexpr std::uintmax_t k_most_bytes = std::uintmax_t{64} << 20U;
    const std::string name = name_of(*next.image);
    std::error_code unknown;
    if (name == loaded_ ||
        std::filesystem::file_size(*next.image->model_file, unknown) > k_most_bytes)
      return;
    try {
      ahead_.start(name, source_of(*next.image, next.use));
    } catch (const Error&) {  // a file that cannot be read fails its own images
    }
  }

  /// What makes the scene, in whatever thread. Reads what `inputs_` must look up here.
  SceneSource source_of(const ImageSpec& image, SceneUse use) {
    return [this, use, engine = image.engine, meshes = &inputs_.meshes(),
            parts = parts_of(image, recipe_, inputs_)] {
      return tracer_.make_ready(scene_of(parts, *meshes), use, engine);
    };
  }

  /// Starts one program. Looks at a few images only: thousands may share one.
  void prepare_next() {
    constexpr int k_most_looks = 8;
    for (int look = 0; look < k_most_looks && !upcoming_.empty(); ++look) {
      const ImageSpec& next = *upcoming_.front();
      upcoming_.pop_front();
      try {
        if (tracer_.prepare_ahead(scene_without_model(recipe_, inputs_, next), next.camera,
                                  next.engine, wanted_light_planes(recipe_.outputs)))
          return;
      } catch (const Error&) {  // a file that cannot be read fails its own images
      }
    }
  }

  Inputs& inputs_;
  const Recipe& recipe_;
  Tracer tracer_;
  std::string loaded_;  ///< name of the tracer's scene; empty: none
  std::deque<const ImageSpec*> upcoming_;
  std::optional<Expected> expected_;
  SceneAhead ahead_;  ///< ends before the tracer does
};

}  // namespace

std::unique_ptr<Renderer> make_tracer_renderer(Inputs& inputs, const Recipe& recipe,
                                               const TracerOptions& options) {
  return std::make_unique<TracerRenderer>(inputs, recipe, options);
}

}  // namespace ds
