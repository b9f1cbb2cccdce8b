// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

struct ModelFile;

/// Which folders above models tell a split: train/chair/a.off and chair/train/a.off are of the training split.
/// A folder is one of these where split_named knows its name and those of all folders beside it that hold
/// models; train and test, written so, are wherever they stand.
class SplitFolders {
 public:
  explicit SplitFolders(const std::vector<ModelFile>& models);

  /// Of a folder in `parent`, which is "" for the one of all models; "" where it tells none.
  std::string_view split_of(const std::string& parent, const std::string& folder) const;

  /// Those that tell a split, by what they are called, and those that are called as if they did.
  const std::map<std::string, std::string>& telling() const { return telling_; }
  const std::set<std::string>& not_telling() const { return not_telling_; }

 private:
  std::map<std::string, std::set<std::string>, std::less<>> inside_;  ///< folders by parent
  std::map<std::string, std::string> telling_;
  std::set<std::string> not_telling_;
};

}  // namespace ds
