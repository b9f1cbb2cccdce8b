// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/environment_facts.h"
#include "builder/recipe/recipe.h"

#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// A file that an image has.
struct OutputKind {
  std::string_view kind;             ///< "image" or a plane's name
  std::string ending;                ///< ".png", ".mask.png"
  std::string_view format;           ///< in the keys: how it is encoded
  const PlaneType* plane = nullptr;  ///< none: the picture
  bool developed = false;            ///< a plane of light that goes through the tone map
};
/// A change of the picture's encoder's settings changes it.
inline constexpr std::string_view k_picture_format = "png 8 bit, zlib 6, version 1";

/// In the order of the files of an image.
std::vector<OutputKind> kinds_of(const OutputSettings& outputs);

/// Path of an output of an image, by its ending: "images/human.ply/0.mask.png".
std::string output_path(const std::string& image_id, std::string_view ending);
/// Paths of all files that an image of the recipe consists of; known of images too whose files
/// cannot be read.
std::vector<std::string> output_paths(const OutputSettings& outputs, const std::string& image_id);
/// Of all outputs that a recipe can ask for: ".png", ".depth.exr".
const std::vector<std::string>& all_output_endings();

/// What is done to the film and which files there are, for `explain`, with what no other part tells
/// and planes hold: ids.
std::string canonical_files(const OutputSettings& outputs, const ToneMap& tone_map,
                            const EnvironmentFacts& environment);

}  // namespace ds
