// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/choice_costs.h"

#include "builder/measure/ladder.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <cmath>

namespace ds {
namespace {

/// Numbers of the pictures' seeds.
constexpr int k_first_seed = 2'000'000;
/// Standard errors of a 95 % bound.
constexpr double k_bound = 1.96;

/// A picture with each of two seeds.
struct Films {
  Film a, b;

  std::optional<double> noise() const {
    if (!a.relative_error || !b.relative_error) return std::nullopt;
    return (*a.relative_error + *b.relative_error) / 2;
  }
};

/// One way of tracing the subject.
struct Variant {
  Films films;
  Interval time;  ///< over the subject's
};

/// Traces the subject, and other ways of it between two pictures of the subject.
class Choosing {
 public:
  Choosing(SceneTracer& tracer, const Subject& subject, int spp, const std::atomic<bool>& stop)
      : tracer_(tracer), subject_(subject), spp_(spp), stop_(stop) {}

  /// First of all: `beside` goes on from the subject's scene and program, and ends with them.
  Films subject() const {
    make_ready(subject_, true, false);
    return {timed(subject_, 0, false).film, timed(subject_, 1, false).film};
  }

  /// `edits_scene`: `other` has a scene of its own. The order subject, other, other, subject takes
  /// out of the ratio what the machine evenly becomes slower or faster by.
  Variant beside(const Subject& other, bool edits_scene, bool plain_sums = false) const {
    const double first = timed(subject_, 0, false).seconds;
    make_ready(other, edits_scene, plain_sums);
    Timed a = timed(other, 0, plain_sums);
    Timed b = timed(other, 1, plain_sums);
    make_ready(subject_, edits_scene, false);
    const double last = timed(subject_, 1, false).seconds;
    Variant variant{{std::move(a.film), std::move(b.film)}, {1, 1, 1}};
    if (first > 0 && last > 0) {
      const auto [least, most] = std::minmax({a.seconds / first, b.seconds / last});
      variant.time = {(least + most) / 2, least, most};
    }
    return variant;
  }

 private:
  struct Timed {
    Film film;
    double seconds;
  };

  /// Packs the scene and compiles the program.
  void make_ready(const Subject& subject, bool set_scene, bool plain_sums) const {
    if (set_scene) tracer_.set_scene(subject.scene);
    picture(subject, 1, 0, plain_sums);
  }
  Film picture(const Subject& subject, int spp, int number, bool plain_sums) const {
    EngineSettings engine = subject.engine;
    engine.spp = spp;
    engine.target.reset();
    engine.seed = report_seed(subject.engine.seed, k_first_seed + number);
    return plain_sums ? tracer_.trace_plain(subject.camera, engine, stop_)
                      : tracer_.trace(subject.camera, engine, stop_);
  }
  Timed timed(const Subject& subject, int number, bool plain_sums) const {
    const double start = tracer_.busy();
    Film film = picture(subject, spp_, number, plain_sums);
    return {std::move(film), tracer_.busy() - start};
  }

  SceneTracer& tracer_;
  const Subject& subject_;
  int spp_;
  const std::atomic<bool>& stop_;
};

ChoiceCost cost_of(const Choice& choice, const Films& films, Interval time, const Films& base,
                   const Films& truth) {
  ChoiceCost cost;
  cost.choice = choice;
  cost.time = time;
  if (films.noise() && base.noise() && *base.noise() > 0)
    cost.noise = *films.noise() / *base.noise();
  const BiasSquare square = relative_bias_square(films.a, films.b, {truth.a, truth.b});
  const double low = square.value - k_bound * square.standard_error;
  const double high = square.value + k_bound * square.standard_error;
  if (low > 0) cost.bias = {std::sqrt(square.value), std::sqrt(low), std::sqrt(high)};
  return cost;
}

}  // namespace

std::vector<ChoiceCost> measure_choices(SceneTracer& tracer, const Subject& subject,
                                        const AccuracyOptions& options,
                                        const std::atomic<bool>& stop) {
  const Choosing choosing(tracer, subject, std::max(4, options.most_spp / 2), stop);
  const Films base = choosing.subject();
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
  const Variant all_paths = choosing.beside(edited(*deepest), false);

  std::vector<ChoiceCost> costs;
  const Variant plain = choosing.beside(subject, false, true);
  costs.push_back(cost_of({"sums", "plain", 0, false, {}}, plain.films, plain.time, base, base));
  // First those of this very scene, which stays packed.
  for (const bool scene : {false, true})
    for (const Choice& choice : choices) {
      if (choice.edits_scene != scene) continue;
      const Variant variant =
          &choice == &*deepest ? all_paths : choosing.beside(edited(choice), scene);
      const bool is_depth = choice.group == k_depth_group;
      costs.push_back(
          cost_of(choice, variant.films, variant.time, base, is_depth ? all_paths.films : base));
    }
  Choice own{k_depth_group, "as the recipe", double(subject.engine.depth_total), false, {}};
  costs.push_back(cost_of(own, base, {1, 1, 1}, base, all_paths.films));
  return costs;
}

}  // namespace ds
