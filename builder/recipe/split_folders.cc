// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/split_folders.h"

#include "builder/recipe/recipe.h"

#include <algorithm>

namespace ds {

SplitFolders::SplitFolders(const std::vector<ModelFile>& models) {
  for (const ModelFile& model : models) {
    std::string parent;
    for (const std::filesystem::path& folder : std::filesystem::path(model.below).parent_path()) {
      inside_[parent].insert(folder.string());
      parent += "/" + folder.string();
    }
  }
  for (const auto& [parent, folders] : inside_)
    for (const std::string& folder : folders) {
      const std::string_view split = split_of(parent, folder);
      if (!split.empty())
        telling_.emplace(folder, split);
      else if (!split_named(folder).empty())
        not_telling_.insert(folder);
    }
}

std::string_view SplitFolders::split_of(const std::string& parent,
                                        const std::string& folder) const {
  const std::string_view split = split_named(folder);
  if (split.empty() || folder == "train" || folder == "test") return split;
  const auto beside = inside_.find(parent);
  const auto is_split = [](const std::string& name) { return !split_named(name).empty(); };
  const bool all = beside != inside_.end() &&
                   std::all_of(beside->second.begin(), beside->second.end(), is_split);
  return all ? split : "";
}

}  // namespace ds
