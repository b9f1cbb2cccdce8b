// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/ladder.h"

#include "builder/measure/flip.h"
#include "builder/measure/plain_sums.h"
#include "builder/measure/ssim.h"
#include "tracer/base/error.h"
#include "tracer/base/hash.h"
#include "tracer/render/develop.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace ds {
namespace {

/// Numbers of the pictures that are references; rungs count from 0.
constexpr int k_reference_a = 1'000'000;
constexpr int k_reference_b = 1'000'001;
/// Each is a launch of its own.
constexpr int k_most_plain_samples = 256;

/// Both halves and their mean, developed.
struct DevelopedReference {
  Reference films;
  BytePicture a, b, mean;
};

Film mean_film(const Film& a, const Film& b) {
  Film mean = a;
  for (std::size_t i = 0; i < mean.rgb.size(); ++i)
    mean.rgb[i] = 0.5f * a.rgb[i] + 0.5f * b.rgb[i];
  return mean;
}

/// What one rung's pictures gave, a number a picture.
struct Samples {
  std::vector<double> seconds, mean_square, rel_mse, rel_mse_trimmed, picture_mean_square, ssim,
      flip, estimate;
};

/// Bounds that chance put beyond what the metric can be, at its end.
Interval cut(const Interval& interval, double least, double most) {
  return {interval.value, std::max(interval.low, least), std::min(interval.high, most)};
}

Rung rung_of(int spp, const Samples& samples) {
  Rung rung;
  rung.spp = spp;
  const auto [least, most] = std::minmax_element(samples.seconds.begin(), samples.seconds.end());
  rung.seconds = {median_of(samples.seconds), *least, *most};
  const auto put = [&](Metric metric, const std::optional<Interval>& interval) {
    if (interval) rung.metrics[metric] = *interval;
  };
  const auto root = [](double square) { return std::sqrt(square); };
  const auto decibels = [](double square) { return psnr_db(square).value(); };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  put(Metric::error, mapped_interval(samples.mean_square, root, 0));
  put(Metric::rel_mse, mapped_interval(samples.rel_mse, std::identity(), 0));
  put(Metric::rel_mse_trimmed, mapped_interval(samples.rel_mse_trimmed, std::identity(), 0));
  put(Metric::psnr_db, mapped_interval(samples.picture_mean_square, decibels, infinity));
  if (!samples.ssim.empty()) put(Metric::ssim, cut(mean_interval(samples.ssim), -1, 1));
  put(Metric::flip, cut(mean_interval(samples.flip), 0, 1));
  if (!samples.estimate.empty()) rung.estimate = mean_of(samples.estimate);
  return rung;
}

class Ladder {
 public:
  Ladder(SceneTracer& tracer, const Subject& subject, const ToneMap& tone_map,
         const std::atomic<bool>& stop)
      : tracer_(tracer), subject_(subject), tone_map_(tone_map), stop_(stop) {}

  Film trace(int spp, int number) const {
    return tracer_.trace(subject_.camera, engine(spp, number), stop_);
  }

  double plain_sums(int spp) const {
    PlainSums plain;
    FilmSums film;
    for (int n = 1; n <= spp; ++n) {
      tracer_.trace_on(subject_.camera, engine(n, 0), film, stop_);
      plain.add(film);
    }
    return plain.relative_error();
  }

  DevelopedReference reference(int spp) const {
    DevelopedReference reference;
    reference.films = {trace(spp, k_reference_a), trace(spp, k_reference_b)};
    reference.a = develop(reference.films.a, tone_map_);
    reference.b = develop(reference.films.b, tone_map_);
    reference.mean = develop(mean_film(reference.films.a, reference.films.b), tone_map_);
    return reference;
  }

  Rung rung(int spp, int first_number, int seeds, const DevelopedReference& reference) const {
    Samples samples;
    for (int i = 0; i < seeds; ++i) {
      const double start = tracer_.now();
      const Film film = trace(spp, first_number + i);
      samples.seconds.push_back(tracer_.now() - start);
      const LinearErrors errors = linear_errors(film, reference.films);
      samples.mean_square.push_back(errors.mean_square);
      samples.rel_mse.push_back(errors.rel_mse);
      samples.rel_mse_trimmed.push_back(errors.rel_mse_trimmed);
      const BytePicture picture = develop(film, tone_map_);
      samples.picture_mean_square.push_back(picture_mean_square(picture, reference.a, reference.b));
      if (const auto similarity = ssim(reference.mean, picture))
        samples.ssim.push_back(*similarity);
      samples.flip.push_back(flip(reference.mean, picture));
      if (film.relative_error) samples.estimate.push_back(*film.relative_error);
    }
    return rung_of(spp, samples);
  }

 private:
  EngineSettings engine(int spp, int number) const {
    EngineSettings engine = subject_.engine;
    engine.spp = spp;
    engine.target.reset();
    engine.seed = report_seed(subject_.engine.seed, number);
    return engine;
  }

  SceneTracer& tracer_;
  const Subject& subject_;
  const ToneMap& tone_map_;
  const std::atomic<bool>& stop_;
};

/// The error of the mean of both halves: half their RMS difference. One picture of it, so no
/// interval.
double reference_error(const Reference& reference) {
  const double mean = (mean_luminance(reference.a) + mean_luminance(reference.b)) / 2;
  if (mean <= 0) return 0;
  // (x - a)(x - b) at the mean x is -(a - b)^2 / 4.
  const Film x = mean_film(reference.a, reference.b);
  return std::sqrt(std::max(0.0, -linear_errors(x, reference).mean_square));
}

}  // namespace

std::vector<int> ladder_of(int most_spp) {
  std::vector<int> rungs;
  for (int spp = 1; spp < most_spp; spp *= 2)
    rungs.push_back(spp);
  rungs.push_back(most_spp);
  return rungs;
}

std::uint64_t report_seed(std::uint64_t recipe_seed, int number) {
  return hash64_text(fmt::format("accuracy report {} {}", recipe_seed, number)) >> 11;
}

void measure_ladder(PairAccuracy& pair, SceneTracer& tracer, const Subject& subject,
                    const ToneMap& tone_map, const AccuracyOptions& options,
                    const std::atomic<bool>& stop) {
  const double start = tracer.now();
  tracer.set_scene(subject.scene);
  const Ladder ladder(tracer, subject, tone_map, stop);
  ladder.trace(1, 0);
  pair.setup_seconds = tracer.now() - start;
  const DevelopedReference reference = ladder.reference(options.most_spp * options.reference);
  pair.reference_error = reference_error(reference.films);
  if (const auto similarity = ssim(reference.a, reference.b))
    pair.floor[Metric::ssim] = *similarity;
  pair.floor[Metric::flip] = flip(reference.a, reference.b);
  pair.plain_sums_spp = std::min(options.most_spp, k_most_plain_samples);
  pair.plain_sums = ladder.plain_sums(pair.plain_sums_spp);
  int number = 1;
  for (const int spp : ladder_of(options.most_spp)) {
    pair.ladder.push_back(ladder.rung(spp, number, options.seeds, reference));
    number += options.seeds;
  }
}

}  // namespace ds
