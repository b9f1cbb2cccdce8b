// SPDX-License-Identifier: Apache-2.0
#include "builder/report/choice_costs.h"

#include "builder/report/ladder.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <cmath>

namespace ds {
namespace {

/// Numbers of the pictures' seeds.
constexpr int k_first_seed = 2'000'000;
constexpr int k_seeds = 2;
/// Standard errors of a 95 % bound.
constexpr double k_bound = 1.96;

/// One way of tracing the subject, with two seeds.
struct Variant {
  Film a, b;
  std::vector<double> seconds;

  std::optional<double> noise() const {
    if (!a.relative_error || !b.relative_error) return std::nullopt;
    return (*a.relative_error + *b.relative_error) / 2;
  }
};

class Choosing {
 public:
  Choosing(SceneTracer& tracer, int spp, const std::atomic<bool>& stop)
      : tracer_(tracer), spp_(spp), stop_(stop) {}

  Variant trace(const Subject& subject, bool plain_sums = false) const {
    Variant variant;
    picture(subject, 1, 0, plain_sums);  // packs, compiles
    variant.a = timed(subject, 0, plain_sums, variant.seconds);
    variant.b = timed(subject, 1, plain_sums, variant.seconds);
    return variant;
  }

 private:
  Film picture(const Subject& subject, int spp, int number, bool plain_sums) const {
    EngineSettings engine = subject.engine;
    engine.spp = spp;
    engine.target.reset();
    engine.seed = report_seed(subject.engine.seed, k_first_seed + number);
    return plain_sums ? tracer_.trace_plain(subject.camera, engine, stop_)
                      : tracer_.trace(subject.camera, engine, stop_);
  }
  Film timed(const Subject& subject, int number, bool plain_sums,
             std::vector<double>& seconds) const {
    const double start = tracer_.busy();
    Film film = picture(subject, spp_, number, plain_sums);
    seconds.push_back(tracer_.busy() - start);
    return film;
  }

  SceneTracer& tracer_;
  int spp_;
  const std::atomic<bool>& stop_;
};

Interval time_ratio(const Variant& variant, const Variant& base) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < k_seeds; ++i)
    if (base.seconds[i] > 0) ratios.push_back(variant.seconds[i] / base.seconds[i]);
  if (ratios.empty()) return {1, 1, 1};
  const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
  return {median_of(ratios), *least, *most};
}

ChoiceCost cost_of(const Choice& choice, const Variant& variant, const Variant& base,
                   const Variant& truth) {
  ChoiceCost cost;
  cost.choice = choice;
  cost.time = time_ratio(variant, base);
  if (variant.noise() && base.noise() && *base.noise() > 0)
    cost.noise = *variant.noise() / *base.noise();
  const BiasSquare square = relative_bias_square(variant.a, variant.b, {truth.a, truth.b});
  const double low = square.value - k_bound * square.standard_error;
  const double high = square.value + k_bound * square.standard_error;
  if (low > 0) cost.bias = {std::sqrt(square.value), std::sqrt(low), std::sqrt(high)};
  return cost;
}

}  // namespace

std::vector<ChoiceCost> measure_choices(SceneTracer& tracer, const Subject& subject,
                                        const AccuracyOptions& options,
                                        const std::atomic<bool>& stop) {
  const Choosing choosing(tracer, std::max(4, options.most_spp / 2), stop);
  tracer.set_scene(subject.scene);
  const Variant base = choosing.trace(subject);
  const std::vector<Choice> choices = choices_for(subject);
  const auto edited = [&](const Choice& choice) {
    Subject other = subject;
    choice.apply(other);
    return other;
  };
  const auto deepest = std::find_if(choices.begin(), choices.end(), [](const Choice& choice) {
    return choice.group == k_depth_group && choice.number == k_deepest;
  });
  DS_ASSERT(deepest != choices.end());
  const Variant all_paths = choosing.trace(edited(*deepest));

  std::vector<ChoiceCost> costs;
  costs.push_back(
      cost_of({"sums", "plain", 0, false, {}}, choosing.trace(subject, true), base, base));
  // First those of this very scene, so that it is packed once.
  for (const bool scene : {false, true})
    for (const Choice& choice : choices) {
      if (choice.edits_scene != scene) continue;
      const Subject other = edited(choice);
      if (scene) tracer.set_scene(other.scene);
      const Variant variant = &choice == &*deepest ? all_paths : choosing.trace(other);
      const bool is_depth = choice.group == k_depth_group;
      costs.push_back(cost_of(choice, variant, base, is_depth ? all_paths : base));
    }
  Choice own{k_depth_group, "as the recipe", double(subject.engine.depth_total), false, {}};
  costs.push_back(cost_of(own, base, base, all_paths));
  return costs;
}

}  // namespace ds
