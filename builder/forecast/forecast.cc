// SPDX-License-Identifier: Apache-2.0
#include "builder/forecast/forecast.h"

#include "builder/make/image_maker.h"
#include "tracer/base/error.h"
#include "tracer/render/schedule.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace ds {
namespace {

/// What the law of errors may be: 1 / n and the cube root bound what is met, and two noisy points
/// tell no better.
constexpr double k_steepest = -1, k_flattest = -1.0 / 3;
/// Scatter assumed where every pair has but one probe.
constexpr double k_assumed_scatter = 0.3;
constexpr double k_assumed_slope_scatter = 0.1;
constexpr int k_assumed_freedom = 10;
constexpr double k_first_spp = Schedule::k_first_spp;

double squared(double x) {
  return x * x;
}

bool tells_slope(const Probe& probe) {
  return probe.low_error && probe.high_error && *probe.low_error > 0 && *probe.high_error > 0;
}

double slope_of(const Probe& probe) {
  return std::log(*probe.high_error / *probe.low_error) /
         std::log(double(probe.high_spp) / probe.low_spp);
}

std::vector<double> slopes_of(const std::vector<Probe>& probes) {
  std::vector<double> slopes;
  for (const Probe& probe : probes)
    if (tells_slope(probe)) slopes.push_back(slope_of(probe));
  return slopes;
}

double spp_of(const std::optional<ErrorLaw>& law, const Samples& samples) {
  if (!samples.error) return samples.spp;
  return law ? std::min(law->spp_for(*samples.error), samples.most_spp) : 1;
}

/// Size of a file, with the trend from few to more samples carried on by logarithm: less noise
/// compresses better, and each halving of the noise saves about as many bits. Never less than half
/// of what was seen. Kept sums are not compressed, and masks hold no samples.
double size_at(const std::string& kind, const ProbedSize& size, const Probe& probe, double spp) {
  if (kind == k_sums_kind || size.low == size.high) return size.high;
  const double doublings = std::log2(double(probe.high_spp) / probe.low_spp);
  const double trend = (size.high - size.low) / doublings;
  const double at = size.high + trend * std::log2(spp / probe.high_spp);
  return std::max(at, 0.5 * size.high);
}

/// Sum over a finite population, from a few of it.
class Total {
 public:
  /// `count` things, of which `values` are some.
  void add(double count, const std::vector<double>& values) {
    const double mean = mean_of(values);
    value_ += count * mean;
    terms_.push_back({count, mean, static_cast<double>(values.size())});
    if (values.size() < 2 || mean <= 0) return;
    for (const double value : values)
      relative_squares_ += squared(value / mean - 1);
    freedom_ += static_cast<int>(values.size()) - 1;
  }
  double value() const { return value_; }
  /// Half of the 95 % interval that the scatter leaves.
  double half() const {
    const int freedom = freedom_ > 0 ? freedom_ : k_assumed_freedom;
    const double scatter =
        freedom_ > 0 ? std::sqrt(relative_squares_ / freedom_) : k_assumed_scatter;
    double variance = 0;
    for (const Term& t : terms_) {
      if (t.count <= t.probes) continue;  // all of them were seen
      variance += squared(t.count * scatter * t.mean) / t.probes * (1 - t.probes / t.count);
    }
    return student_t95(freedom) * std::sqrt(variance);
  }

 private:
  struct Term {
    double count, mean, probes;
  };
  std::vector<Term> terms_;
  double value_ = 0, relative_squares_ = 0;
  int freedom_ = 0;
};

/// Of the probes' slopes about the mean of their pair, pooled over pairs.
struct SlopeScatter {
  double deviation = k_assumed_slope_scatter;
  int freedom = k_assumed_freedom;
};

/// Times of images and of scenes scatter apart, and so do sizes.
struct Totals {
  Total images, scenes, bytes;
  double slope_variance = 0;  ///< of the time, for one standard deviation of a slope
};

Interval interval_of(double value, double half) {
  return {value, std::max(0.0, value - half), value + half};
}

SlopeScatter slope_scatter(const std::vector<ProbedWork>& work) {
  double squares = 0;
  int freedom = 0;
  for (const ProbedWork& pair : work) {
    const std::vector<double> slopes = slopes_of(pair.probes);
    if (slopes.size() < 2) continue;
    const int more = static_cast<int>(slopes.size()) - 1;
    squares += squared(deviation_of(slopes)) * more;
    freedom += more;
  }
  if (freedom == 0) return {};
  return {std::sqrt(squares / freedom), freedom};
}

/// Seconds of a sample of every pixel.
double sample_seconds(const Probe& probe, bool by_error) {
  return by_error && probe.target ? probe.target->sample_seconds : probe.sample_seconds;
}

/// Whether engine.max_spp ends a picture. What is above it by rounding only reaches its error.
bool is_capped(const std::optional<ErrorLaw>& law, const Samples& samples) {
  return samples.error && law && law->spp_for(*samples.error) > samples.most_spp * (1 + 1e-9);
}

/// How much a pair's time changes with its slope: n = (error / c)^(1 / slope) turns about the
/// samples that were probed. That of a capped picture does not.
double time_per_slope(const ProbedWork& pair, const std::vector<std::optional<ErrorLaw>>& laws,
                      const std::vector<double>& spp, const Samples& samples) {
  double sum = 0;
  for (std::size_t i = 0; i < pair.probes.size(); ++i) {
    if (!laws[i] || spp[i] <= 1 || is_capped(laws[i], samples)) continue;
    const Probe& probe = pair.probes[i];
    const double probed = probe.target ? probe.target->spp : probe.high_spp;
    sum += sample_seconds(probe, true) * spp[i] * std::log(spp[i] / probed) / laws[i]->slope;
  }
  return static_cast<double>(pair.work.trace) * sum / static_cast<double>(pair.probes.size());
}

/// Samples a pixel that the films still take to have `spp`, on their average. A film that was kept
/// with more was made for a smaller error, so one go does not come by it: it is started anew.
double missing_spp(const PairWork& work, double spp) {
  if (work.trace == 0) return 0;
  double kept = 0;
  for (const auto& [samples, films] : work.kept)
    if (samples <= spp) kept += samples * static_cast<double>(films);
  return spp - kept / static_cast<double>(work.trace);
}

PairForecast forecast_pair(const ProbedWork& pair, const Samples& samples, Totals& totals,
                           std::map<std::string, double>& by_kind) {
  const bool by_error = samples.error.has_value();
  const std::vector<std::optional<ErrorLaw>> laws = error_laws(pair.probes, by_error);
  PairForecast out;
  out.environment = pair.work.environment;
  out.material = pair.work.material;
  out.images = pair.work.images;
  out.made = pair.work.trace + pair.work.remake;
  std::vector<double> traced;
  std::vector<double> remade;
  std::vector<double> scenes;
  std::vector<double> spp;
  std::vector<double> missing;
  std::vector<double> squares;
  for (std::size_t i = 0; i < pair.probes.size(); ++i) {
    const Probe& probe = pair.probes[i];
    spp.push_back(spp_of(laws[i], samples));
    missing.push_back(missing_spp(pair.work, spp.back()));
    traced.push_back(probe.image_seconds + sample_seconds(probe, by_error) * missing.back());
    remade.push_back(probe.image_seconds);
    scenes.push_back(probe.scene_seconds);
    if (is_capped(laws[i], samples)) out.capped += 1.0 / static_cast<double>(pair.probes.size());
    if (laws[i]) squares.push_back(squared(laws[i]->error(spp.back())));
  }
  if (samples.error)
    totals.slope_variance +=
        squared(time_per_slope(pair, laws, spp, samples)) /
        static_cast<double>(std::max<std::size_t>(1, slopes_of(pair.probes).size()));
  out.spp = mean_of(spp);
  out.traced_spp = mean_of(missing);
  if (out.made > 0)
    out.seconds_an_image = (static_cast<double>(pair.work.trace) * mean_of(traced) +
                            static_cast<double>(pair.work.remake) * mean_of(remade)) /
                           static_cast<double>(out.made);
  if (!squares.empty()) out.error = std::sqrt(mean_of(squares));
  if (pair.work.trace > 0) totals.images.add(static_cast<double>(pair.work.trace), traced);
  if (pair.work.remake > 0) totals.images.add(static_cast<double>(pair.work.remake), remade);
  if (pair.work.scenes > 0) totals.scenes.add(static_cast<double>(pair.work.scenes), scenes);
  for (const auto& [kind, count] : pair.work.files) {
    if (count == 0) continue;
    std::vector<double> sizes;
    for (std::size_t i = 0; i < pair.probes.size(); ++i) {
      const auto found = pair.probes[i].bytes.find(kind);
      if (found != pair.probes[i].bytes.end())
        sizes.push_back(size_at(kind, found->second, pair.probes[i], spp[i]));
    }
    if (sizes.empty()) continue;
    by_kind[kind] += static_cast<double>(count) * mean_of(sizes);
    totals.bytes.add(static_cast<double>(count), sizes);
  }
  return out;
}

double kept_spp(const PlannedImage& image) {
  return static_cast<double>(image.kept_samples) /
         (double(image.spec.engine.width) * image.spec.engine.height);
}

}  // namespace

double ErrorLaw::error(double spp) const {
  return at_one * std::pow(spp, slope);
}

double ErrorLaw::spp_for(double error) const {
  DS_ASSERT(error > 0);
  return std::max(least_spp, std::pow(error / at_one, 1 / slope));
}

std::vector<std::optional<ErrorLaw>> error_laws(const std::vector<Probe>& probes, bool by_error) {
  const std::vector<double> slopes = slopes_of(probes);
  std::vector<std::optional<ErrorLaw>> laws;
  for (const Probe& probe : probes) {
    if (!probe.low_error || !probe.high_error) {
      laws.emplace_back();
      continue;
    }
    ErrorLaw law;
    if (!slopes.empty()) law.slope = std::clamp(mean_of(slopes), k_steepest, k_flattest);
    law.at_one = *probe.high_error * std::pow(probe.high_spp, -law.slope);
    if (by_error && probe.target) {
      law.at_one = probe.target->error * std::pow(probe.target->spp, -law.slope);
      law.least_spp = k_first_spp;
    }
    laws.emplace_back(law);
  }
  return laws;
}

std::vector<PairWork> work_of(const Plan& plan, const Recipe& recipe) {
  using SceneName = std::tuple<std::filesystem::path, std::filesystem::path, std::filesystem::path>;
  std::map<std::pair<std::string, std::string>, PairWork> pairs;
  std::map<std::pair<std::string, std::string>, std::set<SceneName>> scenes;
  for (const PlannedImage& image : plan.images) {
    if (image.elsewhere) continue;
    const std::pair<std::string, std::string> name{*image.spec.environment_name,
                                                   *image.spec.material_name};
    PairWork& pair = pairs[name];
    pair.environment = name.first;
    pair.material = name.second;
    ++pair.images;
    std::uint64_t to_make = 0;
    for (const PlannedFile& file : image.files)
      if (file.state == FileState::to_make) {
        ++pair.files[file.output.kind];
        ++to_make;
      }
    if (image.traces_paths()) {
      ++pair.trace;
      if (image.kept_samples > 0) ++pair.kept[kept_spp(image)];
      if (recipe.keep_film) ++pair.files["film"];
      if (recipe.keep_sums) ++pair.files[k_sums_kind];
    } else if (to_make > 0) {
      ++pair.remake;
    }
    if (image.traces_paths() || image.trace_planes)
      scenes[name].insert(
          {image.spec.model_file, image.spec.material_file, image.spec.environment_folder});
  }
  std::vector<PairWork> work;
  for (auto& [name, pair] : pairs) {
    pair.scenes = scenes[name].size();
    work.push_back(std::move(pair));
  }
  return work;
}

std::vector<ProbedWork> join(const std::vector<PairWork>& work, const Calibration& calibration) {
  std::vector<ProbedWork> joined;
  for (const PairWork& pair : work)
    for (std::size_t i = 0; i < calibration.pairs.size(); ++i)
      if (calibration.pairs[i].environment == pair.environment &&
          calibration.pairs[i].material == pair.material)
        joined.push_back({pair, calibration.probes[i]});
  return joined;
}

Forecast forecast(const std::vector<ProbedWork>& work, const Samples& samples) {
  Forecast out;
  out.by_error = samples.error.has_value();
  Totals totals;
  for (const ProbedWork& pair : work)
    out.pairs.push_back(forecast_pair(pair, samples, totals, out.bytes_by_kind));
  const double seconds = totals.images.value() + totals.scenes.value();
  const SlopeScatter slopes = slope_scatter(work);
  const double of_slopes =
      student_t95(slopes.freedom) * slopes.deviation * std::sqrt(totals.slope_variance);
  out.seconds =
      interval_of(seconds, std::hypot(std::hypot(totals.images.half(), totals.scenes.half()),
                                      k_drift * seconds, of_slopes));
  out.bytes = interval_of(totals.bytes.value(), totals.bytes.half());
  return out;
}

}  // namespace ds
