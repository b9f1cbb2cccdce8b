// SPDX-License-Identifier: Apache-2.0
#include "builder/forecast/probe.h"

#include "builder/make/image_maker.h"
#include "tracer/base/error.h"
#include "tracer/base/hash.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <map>
#include <memory>
#include <set>

namespace ds {
namespace {

/// Camera samples of a probe's longer picture: about a second on two cores.
constexpr int k_most_samples = 2'000'000;
constexpr std::size_t k_probes_in_all = 18;
constexpr std::size_t k_most_of_a_pair = 3;
/// Samples of the pictures that are made only to load a scene.
constexpr int k_cold_spp = 1;

/// Several makers use one renderer, so that a scene stays loaded from one to the next.
class SharedRenderer : public Renderer {
 public:
  explicit SharedRenderer(Renderer& renderer) : renderer_(renderer) {}
  Film trace(const ImageSpec& image, FilmSums* kept,
             const std::function<void(const TraceProgress&)>& progress,
             const std::atomic<bool>& stop) override {
    return renderer_.trace(image, kept, progress, stop);
  }
  LitPlanes trace_light(const ImageSpec& image, const std::vector<const PlaneType*>& types,
                        FilmSums* reached,
                        const std::function<void(const TraceProgress&)>& progress,
                        const std::atomic<bool>& stop) override {
    return renderer_.trace_light(image, types, reached, progress, stop);
  }
  std::vector<Plane> trace_planes(const ImageSpec& image,
                                  const std::vector<const PlaneType*>& types) override {
    return renderer_.trace_planes(image, types);
  }
  std::vector<Plane> trace_distractors(const ImageSpec& image) override {
    return renderer_.trace_distractors(image);
  }
  std::string device() const override { return renderer_.device(); }

 private:
  Renderer& renderer_;
};

/// The recipe at one number of samples, in a folder of its own.
class ProbeBuild {
 public:
  ProbeBuild(const Recipe& recipe, int spp, std::optional<ErrorTarget> target,
             const std::vector<ImageSpec>& images, Inputs& inputs, Renderer& renderer,
             const std::filesystem::path& folder)
      : plan_(plan_of(recipe, spp, target, images, inputs, folder)),
        maker_(
            dataset_, inputs, plan_.texts, disk_,
            [&renderer] { return std::make_unique<SharedRenderer>(renderer); }, Placing::share) {}

  /// Seconds that making the image takes.
  double make(const std::string& id, const ProbeWatch& watch) {
    const double start = watch.now();
    maker_.make(image(id), true, {}, watch.stop);
    return watch.now() - start;
  }

  /// The picture that was made. Only where the recipe makes any.
  Product picture(const std::string& id) {
    for (const OutputFile& output : image(id).keys.outputs)
      if (output.kind == "image") return product(output.key);
    assertion_failed("the recipe makes pictures", __FILE__, __LINE__);
  }

  std::map<std::string, double> bytes(const std::string& id) {
    std::map<std::string, double> sizes;
    for (const OutputFile& output : image(id).keys.outputs)
      sizes[output.kind] = static_cast<double>(product(output.key).size_bytes);
    if (!dataset_.recipe.outputs.image) return sizes;
    if (dataset_.recipe.keep_film)
      sizes["film"] = static_cast<double>(product(image(id).keys.render).size_bytes);
    if (dataset_.recipe.keep_sums)
      sizes[k_sums_kind] = static_cast<double>(product(image(id).keys.kept).size_bytes);
    return sizes;
  }

 private:
  Plan plan_of(const Recipe& recipe, int spp, std::optional<ErrorTarget> target,
               const std::vector<ImageSpec>& images, Inputs& inputs,
               const std::filesystem::path& folder) {
    dataset_.recipe = recipe;
    dataset_.recipe.engine.spp = spp;
    dataset_.recipe.engine.target = target;
    // Identities do not depend on the other models: these alone expand to the same images.
    std::map<std::string, std::filesystem::path> models;
    for (const ImageSpec& image : images)
      models.emplace(*image.model_name, *image.model_file);
    dataset_.recipe.models.clear();
    for (const auto& [name, file] : models)
      dataset_.recipe.models.push_back({.name = name, .file = file});
    dataset_.folder = folder / "out";
    dataset_.row.id = Hash128{0, static_cast<std::uint64_t>(spp)}.hex();
    dataset_.store = std::make_unique<Store>(folder / "store", disk_);
    dataset_.claims = std::make_unique<Claims>(folder / "store" / "lock");
    dataset_.database = std::make_unique<Database>(folder / "store" / "dsbuild.sqlite");
    return make_plan(dataset_, inputs, true);
  }
  const PlannedImage& image(const std::string& id) const {
    const auto found =
        std::find_if(plan_.images.begin(), plan_.images.end(),
                     [&](const PlannedImage& planned) { return planned.spec.id == id; });
    DS_ASSERT(found != plan_.images.end());
    if (found->error) throw *found->error;
    return *found;
  }
  Product product(Hash128 key) const {
    const std::optional<Product> found = dataset_.database->find_product(key);
    DS_ASSERT(found.has_value());
    return *found;
  }

  RealDisk disk_;
  Dataset dataset_;
  Plan plan_;
  ImageMaker maker_;
};

/// The three builds of one recipe that a probe compares.
class Probing {
 public:
  Probing(const Recipe& recipe, Inputs& inputs, const std::vector<ImageSpec>& images,
          Renderer& renderer, const std::filesystem::path& folder, bool by_error)
      : pictures_(recipe.outputs.image),
        samples_(probe_samples(recipe.engine)),
        warm_(recipe, k_cold_spp, std::nullopt, images, inputs, renderer, folder / "warm"),
        cold_(recipe, k_cold_spp, std::nullopt, images, inputs, renderer, folder / "cold"),
        low_(recipe, samples_.low, std::nullopt, images, inputs, renderer, folder / "low"),
        high_(recipe, samples_.high, std::nullopt, images, inputs, renderer, folder / "high") {
    if (!by_error) return;
    DS_ASSERT(pictures_);
    // An error that no picture reaches: max_spp ends it.
    ErrorTarget target{1e-6, k_target_probe_spp, {}};
    if (recipe.engine.target) target.region = recipe.engine.target->region;
    target_.emplace(recipe, samples_.high, target, images, inputs, renderer, folder / "target");
    pixels_ = double(recipe.engine.width) * recipe.engine.height;
  }

  /// Compiles the programs of this image's scene.
  void warm_up(const std::string& id, const ProbeWatch& watch) { warm_.make(id, watch); }

  Probe probe(const std::string& id, const ProbeWatch& watch) {
    const double cold = cold_.make(id, watch);
    const double low = low_.make(id, watch);
    const double high = high_.make(id, watch);
    Probe probe;
    probe.low_spp = samples_.low;
    probe.high_spp = samples_.high;
    // Differences of times: by chance below what they measure, which is above 0.
    if (pictures_) {
      probe.sample_seconds = std::max(0.0, (high - low) / (samples_.high - samples_.low));
      probe.image_seconds = std::max(0.0, low - probe.sample_seconds * samples_.low);
      probe.low_error = low_.picture(id).relative_error;
      probe.high_error = high_.picture(id).relative_error;
    } else {
      // No path is traced, so both did the same.
      probe.image_seconds = (low + high) / 2;
    }
    probe.scene_seconds =
        std::max(0.0, cold - probe.image_seconds - probe.sample_seconds * k_cold_spp);
    for (const auto& [kind, bytes] : low_.bytes(id))
      probe.bytes[kind].low = bytes;
    for (const auto& [kind, bytes] : high_.bytes(id))
      probe.bytes[kind].high = bytes;
    if (target_) probe.target = target_probe(id, probe.image_seconds, watch);
    return probe;
  }

 private:
  std::optional<TargetProbe> target_probe(const std::string& id, double image_seconds,
                                          const ProbeWatch& watch) {
    const double seconds = target_->make(id, watch);
    const FilmFacts facts = target_->picture(id).facts;
    if (!facts.developed_high || facts.samples == 0) return std::nullopt;
    const double spp = static_cast<double>(facts.samples) / pixels_;
    return TargetProbe{spp, *facts.developed_high, std::max(0.0, seconds - image_seconds) / spp};
  }

  bool pictures_;
  ProbeSamples samples_;
  ProbeBuild warm_, cold_, low_, high_;
  std::optional<ProbeBuild> target_;
  double pixels_ = 0;
};

}  // namespace

double wall_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

ProbeSamples probe_samples(const EngineSettings& engine) {
  const double pixels = double(engine.width) * engine.height;
  const auto fitting = static_cast<unsigned>(std::clamp(k_most_samples / pixels, 16.0, 64.0));
  const int high = static_cast<int>(std::bit_floor(fitting));
  return {high / 8, high};
}

std::vector<Probe> probe_images(const Recipe& recipe, Inputs& inputs,
                                const std::vector<ImageSpec>& images, Renderer& renderer,
                                const std::filesystem::path& folder, bool by_error,
                                const ProbeWatch& watch) {
  std::vector<Probe> probes;
  if (images.empty()) return probes;
  Probing probing(recipe, inputs, images, renderer, folder, by_error);
  for (const ImageSpec& image : images)
    probing.warm_up(image.id, watch);
  for (const ImageSpec& image : images) {
    watch.told(fmt::format("calibrating {} of {}: {} in {}, {}", probes.size() + 1, images.size(),
                           *image.material_name, *image.environment_name, image.id));
    probes.push_back(probing.probe(image.id, watch));
  }
  return probes;
}

std::vector<PairImages> images_to_probe(const std::vector<ImageSpec>& images) {
  using Ranked = std::pair<std::uint64_t, const ImageSpec*>;
  std::map<std::pair<std::string, std::string>, std::vector<Ranked>> pairs;
  for (const ImageSpec& image : images)
    pairs[{*image.environment_name, *image.material_name}].emplace_back(
        hash64_text("probe " + image.id), &image);
  if (pairs.empty()) return {};
  const std::size_t most =
      std::clamp<std::size_t>(k_probes_in_all / pairs.size(), 1, k_most_of_a_pair);
  std::vector<PairImages> chosen;
  for (auto& [pair, ranked] : pairs) {
    std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
      return std::tie(a.first, a.second->id) < std::tie(b.first, b.second->id);
    });
    // Other models first: views of one scene say nothing of loading another.
    std::set<std::string> models;
    std::stable_partition(ranked.begin(), ranked.end(), [&](const Ranked& image) {
      return models.insert(*image.second->model_name).second;
    });
    PairImages of_pair{pair.first, pair.second, {}};
    for (std::size_t i = 0; i < std::min(most, ranked.size()); ++i)
      of_pair.images.push_back(*ranked[i].second);
    chosen.push_back(std::move(of_pair));
  }
  return chosen;
}

}  // namespace ds
