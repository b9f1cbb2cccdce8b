// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/measure/choices.h"
#include "builder/measure/effect_choices.h"
#include "builder/measure/fit.h"
#include "builder/measure/geometry_errors.h"
#include "builder/measure/image_errors.h"
#include "builder/plan/inputs.h"
#include "builder/recipe/recipe.h"
#include "tracer/render/film.h"

#include <array>
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// Traces scenes that stand in no file. Virtual so that the measuring can be tested against noise
/// of a known law.
class SceneTracer {
 public:
  virtual ~SceneTracer() = default;
  /// The scene must outlive its tracing.
  virtual void set_scene(const Scene& scene) = 0;
  virtual Film trace(const Camera& camera, const EngineSettings& engine,
                     const std::atomic<bool>& stop) = 0;
  /// As trace, but samples are added in plain floats.
  virtual Film trace_plain(const Camera& camera, const EngineSettings& engine,
                           const std::atomic<bool>& stop) = 0;
  /// Goes on from `sums`, a film of this picture with fewer samples or an empty one.
  virtual void trace_on(const Camera& camera, const EngineSettings& engine, FilmSums& sums,
                        const std::atomic<bool>& stop) = 0;
  virtual Geometry trace_geometry(const Camera& camera, int width, int height) = 0;
  virtual std::string device() const = 0;
  /// Seconds of the wall clock.
  virtual double now() const = 0;
  /// Seconds the device was busy, for ratios: of this process' processors where they are the
  /// device, since others' load hardly moves that; of the wall clock elsewhere.
  virtual double busy() const = 0;
};
std::unique_ptr<SceneTracer> make_scene_tracer(const TracerOptions& options);

/// How much is measured.
struct AccuracyOptions {
  int most_spp = 0;   ///< the ladder's last rung, >= 4; 0: the recipe's spp, at least 16
  int seeds = 4;      ///< independent pictures a rung, 2 .. 64: the error bars come from them
  int reference = 8;  ///< each half of a reference has this many times most_spp, >= 2
  bool choices = true;
};

/// What a picture's error is told in. `error` is relative RMS, the square root of
/// LinearErrors::mean_square: what a manifest's relative_error estimates.
enum class Metric { error, rel_mse, rel_mse_trimmed, psnr_db, ssim, flip };
inline constexpr std::array k_metrics{Metric::error,   Metric::rel_mse, Metric::rel_mse_trimmed,
                                      Metric::psnr_db, Metric::ssim,    Metric::flip};
/// "error", "relmse", "relmse_trimmed", "psnr_db", "ssim", "flip": in CSV and JSON.
const char* metric_name(Metric metric);

/// One rung of the ladder: `seeds` pictures of equal spp.
struct Rung {
  int spp = 0;
  Interval seconds;                    ///< a picture's tracing, median and range over the seeds
  std::map<Metric, Interval> metrics;  ///< without those that could not be told
  std::optional<double> estimate;      ///< mean of Film::relative_error
};

struct GeometryRung {
  int rays = 0;  ///< a pixel
  double seconds = 0;
  GeometryErrors errors;
};

/// What a choice costs beside the subject as the recipe has it.
struct ChoiceCost {
  Choice choice;
  Interval time;  ///< SceneTracer::busy of its tracing over the recipe's, traced just before and
                  ///< after: mean and range of two pairs of pictures
  std::optional<double> noise;  ///< its own noise (Film::relative_error) over the recipe's
  /// Relative RMS difference it makes to a picture without noise, with 95 % bounds; nothing where
  /// the difference is lost in the noise.
  std::optional<Interval> bias;
};

/// Where an error is reached. The bounds of `seconds` hold those of `spp` and those of the line.
struct Target {
  double error = 0;
  Interval spp, seconds;
  bool extrapolated = false;  ///< beyond the ladder
};

/// All that was measured of one environment with one material.
struct PairAccuracy {
  std::string environment, material, image;
  std::uint64_t images = 0;  ///< of the recipe, that show this pair
  double setup_seconds = 0;  ///< loading, tree and program, before the first sample
  std::vector<Rung> ladder;
  std::optional<PowerLaw> law;  ///< of Metric::error against spp
  Line seconds;                 ///< against spp
  std::vector<Target> targets;
  std::string no_targets;          ///< why there are none; empty where there are
  double reference_error = 0;      ///< relative RMS of the reference, by its two halves
  std::map<Metric, double> floor;  ///< what SSIM and FLIP say of the reference's halves
  int plain_sums_spp = 0;
  double plain_sums = 0;  ///< error that plain float sums would add, at plain_sums_spp
  std::vector<GeometryRung> geometry;
  std::vector<ChoiceCost> choices;
  std::vector<KeptEffect> kept;  ///< effects that none of them leaves out
};

struct Accuracy {
  std::string recipe, device;
  EngineSettings engine;
  AccuracyOptions options;
  std::vector<PairAccuracy> pairs;
};

/// Which image stands for each environment and material: the one whose id has the least hash among
/// those that show both, so adding models seldom changes it. Ordered by environment, then material.
struct PairChoice {
  ImageSpec image;
  std::uint64_t images = 0;
};
std::vector<PairChoice> representative_images(const std::vector<ImageSpec>& images);

/// Errors that the report says the time of.
inline constexpr std::array k_target_errors{0.05, 0.02, 0.01};

/// Fills `targets` or `no_targets` from `law` and `seconds`. A picture has a sample a pixel at
/// least, so no time is told of fewer.
void find_targets(PairAccuracy& pair);

/// Measures every pair of the recipe. `told` hears what is measured next. Throws Error(cancelled)
/// soon after `stop` is set.
Accuracy measure_accuracy(const Recipe& recipe, Inputs& inputs, SceneTracer& tracer,
                          const AccuracyOptions& options,
                          const std::function<void(const std::string&)>& told,
                          const std::atomic<bool>& stop);

}  // namespace ds
