// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/forecast/calibration.h"
#include "builder/measure/fit.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// How much of a pair is to be made.
struct PairWork {
  std::string environment, material;
  std::uint64_t images = 0;                    ///< of the recipe
  std::uint64_t trace = 0;                     ///< films to trace
  std::uint64_t remake = 0;                    ///< images of which only other files are made
  std::uint64_t scenes = 0;                    ///< to load: each once, its images follow each other
  std::map<std::string, std::uint64_t> files;  ///< to make, by kind, films too
  /// Of the films to trace those that go on from a kept one: how many have as many samples a pixel.
  std::map<double, std::uint64_t> kept;
};

/// The work that a plan of the recipe leaves, by pair, in the order of images_to_probe. Images that
/// fail count as images only.
std::vector<PairWork> work_of(const Plan& plan, const Recipe& recipe);

/// The greatest engine.max_spp that a recipe can have.
inline constexpr double k_most_spp = 1 << 24;

/// How many samples the images get.
struct Samples {
  std::optional<double> error;   ///< as many as engine.error takes to this one, image by image
  int spp = 1;                   ///< without: this number for all; 0 where there is no picture
  double most_spp = k_most_spp;  ///< engine.max_spp
};

/// What is forecast of one pair.
struct PairForecast {
  std::string environment, material;
  std::uint64_t images = 0, made = 0;
  double spp = 0;               ///< mean; 0 where there is no picture
  double traced_spp = 0;        ///< mean of the films to trace, less what kept ones have
  double error = 0;             ///< RMS relative error (by error: the developed picture's, upper
                                ///< end); 0 where no probe could tell
  double capped = 0;            ///< share of the pictures that engine.max_spp ends: 0 .. 1
  double seconds_an_image = 0;  ///< mean of what is made, without its scene
};

struct Forecast {
  Interval seconds;
  Interval bytes;  ///< new in the store; files in the dataset's folder are links to it
  std::map<std::string, double> bytes_by_kind;
  bool by_error = false;  ///< pairs' errors are engine.error's, else the manifest's relative_error
  std::vector<PairForecast> pairs;
};

/// Pairs that were probed, with the work there is for them.
struct ProbedWork {
  PairWork work;
  std::vector<Probe> probes;  ///< at least one
};
/// Pairs without a probe (none of their images can be read) have no work either.
std::vector<ProbedWork> join(const std::vector<PairWork>& work, const Calibration& calibration);

/// Error of an image against samples: c n^slope, the slope that of all its pair's probes.
struct ErrorLaw {
  double at_one = 0, slope = -0.5;  ///< at_one = 0: a picture without noise
  double least_spp = 1;
  double error(double spp) const;
  /// At least least_spp.
  double spp_for(double error) const;
};
/// One for each probe that knows its errors; others get none. `by_error`: of what engine.error
/// makes, where that was probed: the same slope through the error reached, and at least 16 samples.
std::vector<std::optional<ErrorLaw>> error_laws(const std::vector<Probe>& probes, bool by_error);

/// Time and disk of the work. The interval holds the scatter of the probes (Student's t, pooled
/// over pairs, with the finite number of images taken into account); for an error, that of the
/// slopes too, which counts for more the farther it is from what was probed; and k_drift, by which
/// a device is slower or faster from one minute to another.
Forecast forecast(const std::vector<ProbedWork>& work, const Samples& samples);
/// Between calibrating and building on a machine that others used too it was 10 to 26 %.
inline constexpr double k_drift = 0.15;

}  // namespace ds
