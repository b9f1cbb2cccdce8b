// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/plan.h"
#include "builder/recipe/recipe.h"

#include <cstddef>
#include <string>
#include <vector>

namespace ds {

/// How unevenly chance dealt out materials or environments (assign = "random") over splits and classes.
/// A choice is a model's, or with per = "view" an image's.
struct Uneven {
  std::string kind;  ///< "materials", "environments"
  /// The split where the shares of choices are farthest apart, if one is more than half as large again as
  /// an even share, or less than half of it, and they differ by two choices or more; else no names.
  std::string split, most, least;
  double most_share = 0, least_share = 0, even_share = 0;
  /// Classes of a split with at least as many choices as there are candidates, and "car (train)" of those
  /// that never show one of them.
  std::size_t classes = 0;
  std::vector<std::string> lacking;
};

/// Where there is something to say. Not of what is split by itself.
std::vector<Uneven> find_uneven(const Recipe& recipe, const Plan& plan);

/// "materials fall unevenly: ...".
std::string to_text(const Uneven& uneven);

}  // namespace ds
