// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/accuracy.h"

#include "builder/measure/choice_costs.h"
#include "builder/measure/flip.h"
#include "builder/measure/ladder.h"
#include "builder/measure/ssim.h"
#include "builder/plan/image_parts.h"
#include "builder/plan/image_scene.h"
#include "builder/plan/keys.h"
#include "tracer/base/error.h"
#include "tracer/base/hash.h"
#include "tracer/render/images.h"
#include "tracer/scene/sdl.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <optional>
#include <tuple>

namespace ds {
namespace {

class RealSceneTracer : public SceneTracer {
 public:
  explicit RealSceneTracer(const TracerOptions& options) : options_(options), tracer_(options) {}

  void set_scene(const Scene& scene) override {
    tracer_.set_scene(scene);
    scene_ = &scene;
    plain_tracer_.reset();
  }
  Film trace(const Camera& camera, const EngineSettings& engine,
             const std::atomic<bool>& stop) override {
    return tracer_.trace(camera, engine, {}, &stop);
  }
  Film trace_plain(const Camera& camera, const EngineSettings& engine,
                   const std::atomic<bool>& stop) override {
    DS_ASSERT(scene_ != nullptr);
    if (!plain_tracer_) {
      TracerOptions options = options_;
      options.plain_sums = true;
      plain_tracer_.emplace(options).set_scene(*scene_);
    }
    return plain_tracer_->trace(camera, engine, {}, &stop);
  }
  void trace_on(const Camera& camera, const EngineSettings& engine, FilmSums& sums,
                const std::atomic<bool>& stop) override {
    tracer_.trace(camera, engine, {}, &stop, &sums);
  }
  Geometry trace_geometry(const Camera& camera, int width, int height) override {
    return tracer_.trace_geometry(camera, width, height);
  }
  std::string device() const override { return tracer_.device_name(); }
  double now() const override {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }
  double busy() const override {
    return is_cpu_ ? static_cast<double>(std::clock()) / CLOCKS_PER_SEC : now();
  }

 private:
  TracerOptions options_;
  Tracer tracer_;
  const Scene* scene_ = nullptr;
  std::optional<Tracer> plain_tracer_;  ///< made where it is asked for
  bool is_cpu_ = tracer_.runs_on_cpu();
};

/// Most rays of a supersampled mask: its tables then take about 300 MB.
constexpr double k_most_geometry_rays = 4096.0 * 4096.0;
constexpr int k_most_side = 16384;
/// Of each size, all alike: one of a millisecond may take five by chance.
constexpr int k_mask_pictures = 5;

int finest_factor(int width, int height) {
  int factor = 16;
  while (factor > 1 && (double(width) * factor * height * factor > k_most_geometry_rays ||
                        std::max(width, height) * factor > k_most_side))
    factor /= 2;
  return factor;
}

std::vector<GeometryRung> measure_geometry(SceneTracer& tracer, const Subject& subject) {
  const int width = subject.engine.width;
  const int height = subject.engine.height;
  const int finest = finest_factor(width, height);
  const auto traced = [&](int factor) {
    return coverage_of(tracer.trace_geometry(subject.camera, width * factor, height * factor),
                       factor);
  };
  const Coverage reference = traced(finest);  // compiles the program too, before any time is taken
  std::vector<GeometryRung> rungs;
  for (int factor = 1; factor < finest; factor *= 2) {
    std::vector<double> seconds;
    Coverage coverage;
    for (int i = 0; i < k_mask_pictures; ++i) {
      const double start = tracer.now();
      coverage = traced(factor);
      seconds.push_back(tracer.now() - start);
    }
    rungs.push_back({factor * factor, median_of(seconds), geometry_errors(coverage, reference)});
  }
  return rungs;
}

void fit(PairAccuracy& pair) {
  std::vector<double> spp;
  std::vector<double> errors;
  std::vector<double> seconds;
  for (const Rung& rung : pair.ladder) {
    spp.push_back(rung.spp);
    seconds.push_back(rung.seconds.value);
    const auto error = rung.metrics.find(Metric::error);
    errors.push_back(error == rung.metrics.end() ? 0 : error->second.value);
  }
  pair.law = fit_power_law(spp, errors);
  pair.seconds = fit_line(spp, seconds);
  find_targets(pair);
}

Subject subject_of(const ImageSpec& image, const Recipe& recipe, Inputs& inputs) {
  Subject subject;
  subject.scene = scene_of(parts_of(image, recipe, inputs), inputs.meshes());
  load_images(subject.scene);
  subject.camera = image.camera;
  subject.engine = image.engine;
  return subject;
}

}  // namespace

std::unique_ptr<SceneTracer> make_scene_tracer(const TracerOptions& options) {
  return std::make_unique<RealSceneTracer>(options);
}

const char* metric_name(Metric metric) {
  switch (metric) {
    case Metric::error:
      return "error";
    case Metric::rel_mse:
      return "relmse";
    case Metric::rel_mse_trimmed:
      return "relmse_trimmed";
    case Metric::psnr_db:
      return "psnr_db";
    case Metric::ssim:
      return "ssim";
    case Metric::flip:
      return "flip";
  }
  assertion_failed("a Metric", __FILE__, __LINE__);
}

void find_targets(PairAccuracy& pair) {
  pair.targets.clear();
  pair.no_targets.clear();
  if (!pair.law)
    pair.no_targets = "its errors are lost in the reference's noise";
  else if (!(pair.law->line.slope_interval().high < 0))
    pair.no_targets = "the fall of its error is lost in the noise";
  else if (!(pair.seconds.slope_interval().low > 0))
    pair.no_targets = "the time of a sample is lost in the noise of the pictures' times";
  if (!pair.no_targets.empty()) return;
  for (const double error : k_target_errors) {
    const Interval spp = pair.law->n_for(error).value();
    const auto seconds = [&](double n) { return pair.seconds.interval_at(std::max(1.0, n)); };
    // The line rises, so these are in order.
    const Interval time{seconds(spp.value).value, std::max(0.0, seconds(spp.low).low),
                        seconds(spp.high).high};
    if (!(time.value > 0)) {
      pair.no_targets = "the time of few samples is lost in the noise of the pictures' times";
      pair.targets.clear();
      return;
    }
    pair.targets.push_back(
        {error, spp, time, spp.value < pair.law->least_n || spp.value > pair.law->most_n});
  }
}

std::vector<PairChoice> representative_images(const std::vector<ImageSpec>& images) {
  using Pair = std::pair<std::string, std::string>;
  std::map<Pair, PairChoice> pairs;
  std::map<Pair, std::pair<std::uint64_t, std::string>> least;
  for (const ImageSpec& image : images) {
    const Pair pair{*image.environment_name, *image.material_name};
    const std::pair<std::uint64_t, std::string> rank{hash64_text("accuracy " + image.id), image.id};
    const auto found = least.find(pair);
    if (found == least.end() || rank < found->second) {
      least[pair] = rank;
      pairs[pair].image = image;
    }
    ++pairs[pair].images;
  }
  std::vector<PairChoice> chosen;
  for (auto& [pair, choice] : pairs)
    chosen.push_back(std::move(choice));
  return chosen;
}

Accuracy measure_accuracy(const Recipe& recipe, Inputs& inputs, SceneTracer& tracer,
                          const AccuracyOptions& options,
                          const std::function<void(const std::string&)>& told,
                          const std::atomic<bool>& stop) {
  Accuracy accuracy{recipe.name, tracer.device(), recipe.engine, options, {}};
  if (accuracy.options.most_spp == 0) accuracy.options.most_spp = std::max(16, recipe.engine.spp);
  std::vector<PairChoice> pairs = representative_images(expand(recipe));
  ImageSettler settler(recipe, inputs);
  for (PairChoice& chosen : pairs) {
    settler.settle(chosen.image);
    told(fmt::format("{} of {}: {} in {}, {}", accuracy.pairs.size() + 1, pairs.size(),
                     *chosen.image.material_name, *chosen.image.environment_name, chosen.image.id));
    const Subject subject = subject_of(chosen.image, recipe, inputs);
    const ToneMap& tone_map =
        tone_map_of(recipe, inputs.environment(chosen.image.environment_folder));
    PairAccuracy pair;
    pair.environment = *chosen.image.environment_name;
    pair.material = *chosen.image.material_name;
    pair.image = chosen.image.id;
    pair.images = chosen.images;
    measure_ladder(pair, tracer, subject, tone_map, accuracy.options, stop);
    fit(pair);
    pair.geometry = measure_geometry(tracer, subject);
    if (options.choices) {
      pair.choices = measure_choices(tracer, subject, accuracy.options, stop);
      pair.kept = effect_choices(subject).kept;
    }
    accuracy.pairs.push_back(std::move(pair));
  }
  return accuracy;
}

}  // namespace ds
