// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/make/renderer.h"
#include "builder/plan/plan.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// A file's size at the probe's fewer and at its more samples.
struct ProbedSize {
  double low = 0, high = 0;
};

/// A picture with engine.error, ended by engine.max_spp. Its steps do not know either, so this is
/// what a picture takes that is to have the error reached here.
struct TargetProbe {
  double spp = 0;             ///< samples a pixel, on the picture's average
  double error = 0;           ///< upper end of the developed picture's error
  double sample_seconds = 0;  ///< a sample of every pixel
};

/// What making one image was measured to take, with few samples.
struct Probe {
  int low_spp = 0, high_spp = 0;
  double scene_seconds = 0;   ///< once for a scene: reading, tree, upload
  double image_seconds = 0;   ///< all else that does not grow with samples: mask, encoding, disk
  double sample_seconds = 0;  ///< a sample of every pixel; 0 without a picture
  std::optional<double> low_error, high_error;  ///< Film::relative_error; none without a picture
  std::map<std::string, ProbedSize> bytes;      ///< by kind of product
  std::optional<TargetProbe> target;            ///< where it was asked for
};

/// Who looks on while probes are made.
struct ProbeWatch {
  std::function<void(const std::string&)> told;  ///< hears what is made next
  std::function<double()> now;                   ///< seconds; wall_clock but in tests
  const std::atomic<bool>& stop;
};
double wall_clock();

/// The samples a probe takes: few enough that a probe is short, the fewer at least 2 so that its
/// error is known, and eight times apart so that the slope between them is.
struct ProbeSamples {
  int low = 2, high = 16;
};
ProbeSamples probe_samples(const EngineSettings& engine);
/// Of a TargetProbe: engine.error begins to choose where samples go after 16.
inline constexpr int k_target_probe_spp = 64;

/// Makes images in a folder of their own as a build would, forced, and measures what it takes.
/// `by_error`: with a TargetProbe each, which needs a recipe that makes pictures. An image whose
/// scene is that of the one before tells nothing of loading it. `folder` must be on the file system
/// that the dataset is to be on for its writing to count; it is filled and may be removed
/// afterwards. `images` are of `recipe`. Throws what making them throws.
std::vector<Probe> probe_images(const Recipe& recipe, Inputs& inputs,
                                const std::vector<ImageSpec>& images, Renderer& renderer,
                                const std::filesystem::path& folder, bool by_error,
                                const ProbeWatch& watch);

/// The images that stand for each environment and material: those whose ids have the least hashes,
/// of different models where there are, at most three of a pair and about eighteen in all, at least
/// one of each pair. Ordered by environment, then material.
struct PairImages {
  std::string environment, material;
  std::vector<ImageSpec> images;
};
std::vector<PairImages> images_to_probe(const std::vector<ImageSpec>& images);

}  // namespace ds
