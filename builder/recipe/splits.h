// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/recipe.h"
#include "builder/recipe/settings.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace ds {

/// classes.split, checked against models, materials, environments and views, which must be read.
void read_split(Settings& settings, Recipe& recipe);

/// Train or test, and the fold, of whatever classes.split.by names.
///
/// Each of them is of the test split where a hash of its own is below the share, so that one more moves no
/// other. Where chance leaves materials, environments or views, which are few, without train or without
/// test and there are two or more, the one whose hash is nearest to the other side goes over. With
/// classes.split.stratified the test split takes of each class its share, rounded, and one at least of
/// two or more and not all: those of the least hashes, so that one more moves one other at most.
///
/// Folds are by another hash; with classes.split.stratified those of a class that are not test are as many
/// in each fold as in any other, give or take one: of folds that have too many the last by that hash go
/// where there are too few.
class Splits {
 public:
  /// The recipe must outlive it.
  explicit Splits(const Recipe& recipe);

  /// Split and class of a model; the split stays open ("") where it is not models that are split.
  ModelLabel of_model(const std::string& model) const;
  /// The split of an image of a model of that label, which shows the thing of that name that
  /// classes.split.by names.
  std::string of_image(const ModelLabel& label, const std::string& thing) const;
  /// Of an image of that split; nothing without folds, and of the test split.
  std::optional<std::uint64_t> fold(const std::string& split, const std::string& thing) const;

 private:
  double place(const std::string& thing) const;
  double fold_place(const std::string& thing) const;
  std::uint64_t fold_by_hash(const std::string& thing) const;
  /// By hash. `both`: a group of two or more is to be in both splits.
  void enter(const std::map<std::string, double>& group, bool both);
  /// Its share, by the order of hashes.
  void enter_share(const std::map<std::string, double>& group);
  void enter_folds();

  const Recipe& recipe_;
  std::map<std::string, bool> is_test_;           ///< by thing
  std::map<std::string, std::uint64_t> fold_of_;  ///< by thing, where not by hash alone
};

}  // namespace ds
