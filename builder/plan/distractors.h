// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/inputs.h"
#include "builder/recipe/recipe.h"
#include "tracer/device/plane_types.h"

#include <string>
#include <unordered_map>

namespace ds {

/// An upright one, around a model's box as it stands in the world. Metres.
struct Cylinder {
  double x = 0, y = 0, radius = 0;
  double low = 0, high = 0;
};
/// Whether less than the gap is between them, seen from above.
bool touch(const Cylinder& a, const Cylinder& b, double gap);

/// Gives an image, whose own model and camera are settled, its distractors: each where it stands on the
/// ground as models do, its cylinder distractors.gap_m at least from the model's and those of lower number, and
/// the camera that far outside of it. The first place that is drawn so counts; one for which distractors.tries
/// give none is left out and counted in ImageSpec::unplaced. Throws what reading a model throws.
void place_distractors(ImageSpec& image, const Recipe& recipe, Inputs& inputs);

/// That of a distractor as its file has it: the recipe's, or its model's own.
const Scene& material_file_of(const Distractor& distractor, Inputs& inputs);

/// "distractors[2]".
std::string distractor_name(const Distractor& distractor);

/// What distractors are in keys.
class DistractorTexts {
 public:
  DistractorTexts(const Recipe& recipe, Inputs& inputs) : recipe_(recipe), inputs_(inputs) {}

  /// Canonical text of all that pictures show of them; "" where there are none.
  std::string of_picture(const ImageSpec& image);
  /// Of what a plane sees, which is not of the model alone.
  std::string of_plane(const ImageSpec& image, const PlaneType& plane);
  /// What of their materials a program depends on, in a text that names it; "" where there are none.
  std::string programs(const ImageSpec& image);

 private:
  struct Facts {
    std::string material, colours, ids, program;
    MeshExtras reads;
  };
  const Facts& facts_of(const Distractor& distractor);
  /// Hashes of its material as it is drawn.
  std::string material_of_own(const Distractor& distractor);
  std::string colours_of_own(const Distractor& distractor);

  const Recipe& recipe_;
  Inputs& inputs_;
  std::unordered_map<std::string, Facts> facts_;  ///< by material file
};

}  // namespace ds
