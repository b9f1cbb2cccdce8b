// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/recipe.h"
#include "builder/recipe/settings.h"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace ds {

/// classes.split, checked against models, materials, environments and views, which must be read.
void read_split(Settings& settings, Recipe& recipe);

/// Train, val or test, and the fold, of whatever classes.split.by names.
///
/// Each of them is of the test split where a hash of its own is below the share of test, and of val where it is
/// below the shares of both: so one more moves no other, and val takes nothing from test. Where chance
/// leaves classes, materials, environments or views, which are few, without one of the splits, and there are
/// as many as there are splits, the nearest by hash go over. With classes.split.stratified the splits take of
/// each class their shares: test its own, rounded, val what both have together, rounded, less that; and one
/// at least where there are enough: those of the least hashes, so that one more moves one other of each split
/// at most. Where held_out or class files say what is test, val takes its share of what they leave to train.
///
/// Folds are by another hash; with classes.split.stratified those of a class that are train are as many
/// in each fold as in any other, give or take one: of folds that have too many the last by that hash go
/// where there are too few.
class Splits {
 public:
  /// The recipe must outlive it.
  explicit Splits(const Recipe& recipe);

  /// Split and class of a model; the split stays open ("") where it is not whole models that are split.
  ModelLabel of_model(const std::string& model) const;
  /// The split of an image of a model of that label, which shows the thing of that name that
  /// classes.split.by names.
  std::string of_image(const ModelLabel& label, const std::string& thing) const;
  /// Of an image of that split; nothing without folds, of the splits val and test, and where there is no
  /// such thing ("").
  std::optional<std::uint64_t> fold(const std::string& split, const std::string& thing) const;

 private:
  using Places = std::map<std::string, double>;  ///< hashes by thing, in [0, 1)
  struct Shares;
  enum class Take { by_hash, of_each, by_share };

  double place(const std::string& thing) const;
  double fold_place(const std::string& thing) const;
  std::uint64_t fold_by_hash(const std::string& thing) const;
  void deal(const std::set<std::string>& things, const Shares& shares);
  void enter(const Places& group, const Shares& shares, Take take);
  void enter_folds();

  const Recipe& recipe_;
  std::map<std::string, std::string> split_of_;   ///< by thing
  std::map<std::string, std::uint64_t> fold_of_;  ///< by thing, where not by hash alone
};

/// What of an image classes.split.by names; "" of an image without a class, where it names these.
const std::string& split_thing(const ImageSpec& image, SplitBy by);

}  // namespace ds
