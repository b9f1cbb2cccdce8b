// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/check/check.h"

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// Says of all models, by name, which are one mesh: those of one number. They are where the model's parts of
/// their render keys meet (which have the mesh, how it was set up, and uvs and colours where the material reads
/// them), or where shape and box of their files are the same: that holds however the recipe turns, scales and
/// moves each. A mesh mirrored within its own box has these too, and counts as the same: `doubt` says so.
class Meshes {
 public:
  explicit Meshes(const std::vector<ImageRecord>& images,
                  const std::map<std::string, std::string>& shapes);

  std::size_t of(const std::string& model) const;
  std::size_t count() const { return count_; }
  /// ": the same or mirrored" of models that are one mesh by shape and box alone, else "".
  std::string doubt(const std::vector<std::string>& models) const;

 private:
  std::map<std::string_view, std::size_t> numbers_;
  std::map<std::string_view, std::size_t> by_key_;  ///< the same where keys meet
  std::size_t count_ = 0;
};

/// How far the shapes of two models may be apart for them to be near (leaks).
inline constexpr Threshold k_leaks_near{
    "leaks_near_shape",
    0.03,
    {.least = 0},
    "How alike the shapes of two models in two splits, folds or classes may be, whichever way they "
    "are turned, scaled, mirrored or cut into triangles (shape_distance): see Checks. 0: they are "
    "not compared"};

/// Two models, by the first image of each.
struct ModelPair {
  const ImageRecord *a, *b;
};

/// All pairs whose shapes are within k_leaks_near and that are not one mesh.
std::vector<ModelPair> near_pairs(const CheckInput& input, const Meshes& meshes);
/// The first image of each model that has a shape.
std::vector<const ImageRecord*> shaped_models(const CheckInput& input);

}  // namespace ds
