// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/forecast/probe.h"

#include <filesystem>
#include <optional>
#include <string>

namespace ds {

/// Where probes are kept: one JSON file each, calibration/<key>.json under this folder; a file that
/// is torn, foreign or of another version counts as absent. Safe beside other processes.
class CalibrationCache {
 public:
  explicit CalibrationCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::optional<Probe> find(Hash128 key) const;
  /// Throws Error(io).
  void put(Hash128 key, const Probe& probe) const;

 private:
  std::filesystem::path path_of(Hash128 key) const;
  std::filesystem::path folder_;
};

/// What a probe of this image depends on: every part of its render key (the program's text is in
/// it) but the samples, what is kept of the film, and the device. `keys` are of the image at
/// probe_samples().high.
Hash128 probe_key(const ImageKeys& keys, const Recipe& recipe, const std::string& device);

/// "{...}": the probe's fields by their names.
std::string to_json_text(const Probe& probe);
/// Nothing for a text that to_json_text did not write.
std::optional<Probe> probe_from_json(const std::string& text);

struct Calibration {
  std::vector<PairImages> pairs;
  std::vector<std::vector<Probe>> probes;  ///< as long as `pairs`, one for each of its images
  std::size_t measured = 0;                ///< of these, now
  std::string device;
};

/// What is to be measured.
struct CalibrationWish {
  bool again = false;     ///< all anew, not from the cache
  bool by_error = false;  ///< with a TargetProbe each, where the recipe makes pictures
};

/// Probes of the recipe's images, from the cache where they are there.
/// Images that cannot be read are left out. Works in `scratch`, which is removed afterwards, what
/// is thrown or not. Throws what making an image throws.
Calibration calibrate(const Recipe& recipe, Inputs& inputs, Renderer& renderer,
                      const CalibrationCache& cache, const CalibrationWish& wish,
                      const std::filesystem::path& scratch, const ProbeWatch& watch);

}  // namespace ds
