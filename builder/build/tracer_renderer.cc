// SPDX-License-Identifier: Apache-2.0
#include "builder/build/renderer.h"
#include "tracer/scene/sdl.h"

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
    return tracer_.trace(image.camera, image.engine, progress, &stop, kept);
  }
  Geometry trace_geometry(const ImageSpec& image) override {
    load(image);
    return tracer_.trace_geometry(image.camera, image.engine.width, image.engine.height);
  }
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

  Inputs& inputs_;
  const Recipe& recipe_;
  Tracer tracer_;
  std::optional<SceneName> loaded_;
};

}  // namespace

std::unique_ptr<Renderer> make_tracer_renderer(Inputs& inputs, const Recipe& recipe,
                                               const TracerOptions& options) {
  return std::make_unique<TracerRenderer>(inputs, recipe, options);
}

}  // namespace ds
