// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/check/check.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// One way in which a dataset's images are set apart, so that what is learned from some is tested on others.
struct Division {
  std::string_view one, many;  ///< "split", "splits"
  /// "train", "fold 2"; nothing for an image that takes no part.
  std::optional<std::string> (*part_of)(const ImageRecord& image);

  /// Whether both take part, in different ones.
  bool parts(const ImageRecord& a, const ImageRecord& b) const;
};

/// Splits and folds, those of two parts or more.
std::vector<Division> divisions_of(const std::vector<ImageRecord>& images);

/// What the recipe splits: "model", "class", "material", "environment" or "view".
std::string split_by(const CheckInput& input);

/// "split" where the images are in different ones, else "fold" where they are in different folds, else "".
std::string_view divided_by(const ImageRecord& a, const ImageRecord& b);

/// "mug.ply (test)"; the name alone where there is no part.
std::string name_in(std::string_view name, std::string_view part);

/// How many pairs there are of things in different parts, by the number of things in each.
std::uint64_t pairs_apart(const std::map<std::string, std::uint64_t>& counts);

}  // namespace ds
