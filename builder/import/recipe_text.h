// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace ds {

/// What an import writes into its recipe.
struct RecipeFacts {
  std::string name;               ///< of the dataset
  std::string from;               ///< what was imported, for the first line
  std::string models_dir;         ///< as the recipe writes it
  bool names_by_path = false;     ///< models.names
  bool has_classes = false;       ///< classes.csv and ids.txt lie beside it
  bool has_splits = false;        ///< classes.csv has them
  std::vector<std::string> more;  ///< files of further classifications
  std::string own;                ///< which models have materials of their own; "": none
};

/// A recipe with a comment for each choice that is likely to be changed.
std::string recipe_text(const RecipeFacts& facts);

}  // namespace ds
