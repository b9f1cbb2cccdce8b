// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/inputs.h"
#include "builder/recipe/recipe.h"
#include "tracer/accel/ray_tree.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace ds {

/// Why a view that was drawn is not kept: the condition, and its value.
struct Rejection {
  std::string
      condition;  ///< "in_frame", "visible", "clearance_m", "inside"; "" for a view that is kept
  double value = 0;
};

/// camera.keep for image after image of a recipe, each settled but for that: model and environment must
/// be where they will be.
///
/// in_frame: 1 less what count_beyond finds outside of a picture of 128 pixels; 0 where some of the model is
/// beside or behind the camera. visible: of the rays through the middles of 64 x 64 fields of the picture
/// that meet the model alone, those before which nothing of the environment lies that cameras see, and no
/// distractor; 0 where
/// none meets it. clearance_m: from the camera, and each of the recipe's lights that stands somewhere, to the
/// nearest of either; 0 of a light in the model. inside: the camera is where three
/// rays leave the model by an odd number of surfaces.
///
/// What was found out is kept in the database by all it depends on.
class ViewConditions {
 public:
  ViewConditions(const Recipe& recipe, Inputs& inputs) : recipe_(recipe), inputs_(inputs) {}

  Rejection reject(const ImageSpec& image);

 private:
  struct PlacedModel {
    std::filesystem::path file;
    NormaliseOptions options;  ///< not turned, at the origin
    RayTree tree;
    Mat4 to_world;  ///< of the file's coordinates
  };
  /// What may stand before the model.
  struct Hider {
    std::string file;  ///< of others_
    Mat4 to_tree;      ///< from the world
  };
  PlacedModel placed(const std::filesystem::path& file, NormaliseOptions options);
  std::vector<Hider> hiders_of(const ImageSpec& image);
  Rejection look(const ImageSpec& image);
  const RayTree& around(const ImageSpec& image);
  const PlacedModel& model_of(const ImageSpec& image);
  double in_frame(const ImageSpec& image);

  const Recipe& recipe_;
  Inputs& inputs_;
  std::map<std::filesystem::path, RayTree> environments_;
  std::map<std::string, PlacedModel> others_;  ///< distractors' models, by file
  std::unique_ptr<PlacedModel> model_;         ///< the last: a model's images follow each other
};

}  // namespace ds
