// SPDX-License-Identifier: Apache-2.0
#include "builder/make/plane_outputs.h"
#include "builder/make/renderer.h"
#include "builder/plan/keys.h"
#include "tracer/base/error.h"
#include "tracer/scene/sdl.h"

#include <deque>
#include <filesystem>
#include <optional>
#include <tuple>

namespace ds {
namespace {

class TracerRenderer : public Renderer {
 public:
  TracerRenderer(Inputs& inputs, const Recipe& recipe, const TracerOptions& options)
      : inputs_(inputs), recipe_(recipe), tracer_(options) {}

  Film trace(const ImageSpec& image, FilmSums* kept,
             const std::function<void(const TraceProgress&)>& progress,
             const std::atomic<bool>& stop) override {
    load(image);
    tracer_.prepare(image.camera, image.engine);
    prepare_next();
    return tracer_.trace(image.camera, image.engine, progress, &stop, kept);
  }
  LitPlanes trace_light(const ImageSpec& image, const std::vector<const PlaneType*>& types,
                        FilmSums* reached,
                        const std::function<void(const TraceProgress&)>& progress,
                        const std::atomic<bool>& stop) override {
    load(image);
    tracer_.prepare(image.camera, image.engine, types);
    prepare_next();
    return tracer_.trace_light(image.camera, image.engine, types, progress, &stop, reached);
  }
  std::vector<Plane> trace_planes(const ImageSpec& image,
                                  const std::vector<const PlaneType*>& types) override {
    load(image);
    return tracer_.trace_planes(image.camera, image.engine.width, image.engine.height, types);
  }
  void announce(std::vector<const ImageSpec*> images) override {
    upcoming_.assign(images.begin(), images.end());
  }
  ProgramCounts programs() const override { return tracer_.programs(); }
  std::string device() const override { return tracer_.device_name(); }

 private:
  using SceneName = std::tuple<std::filesystem::path, std::filesystem::path, std::filesystem::path>;

  void load(const ImageSpec& image) {
    const SceneName wanted{image.model_file, image.material_file, image.environment_folder};
    if (loaded_ == wanted) return;
    loaded_.reset();  // a scene that fails half way is not the one before
    Mesh mesh = inputs_.model_mesh(image.model_file, recipe_.normalise);
    tracer_.set_scene(compose(inputs_.environment(image.environment_folder),
                              inputs_.material(image.material_file), std::move(mesh)));
    loaded_ = wanted;
  }

  /// Starts one program. Looks at a few images only: thousands may share one.
  void prepare_next() {
    constexpr int k_most_looks = 8;
    for (int look = 0; look < k_most_looks && !upcoming_.empty(); ++look) {
      const ImageSpec& next = *upcoming_.front();
      upcoming_.pop_front();
      try {
        if (tracer_.prepare_ahead(scene_without_model(inputs_, next), next.camera, next.engine,
                                  wanted_light_planes(recipe_.outputs)))
          return;
      } catch (const Error&) {  // a file that cannot be read fails its own images
      }
    }
  }

  Inputs& inputs_;
  const Recipe& recipe_;
  Tracer tracer_;
  std::optional<SceneName> loaded_;
  std::deque<const ImageSpec*> upcoming_;
};

}  // namespace

std::unique_ptr<Renderer> make_tracer_renderer(Inputs& inputs, const Recipe& recipe,
                                               const TracerOptions& options) {
  return std::make_unique<TracerRenderer>(inputs, recipe, options);
}

}  // namespace ds
