// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/manifest.h"

#include <set>
#include <string>
#include <vector>

namespace ds {

/// "models/mug.ply", "materials/red-plastic", "environments/studio": what the image shows, its objects
/// too. Materials that a model brings along are that model's.
std::vector<std::string> shown_assets(const ImageRecord& image, const DatasetRecord& dataset);

/// Assets as licences and sources name them: a material with its file's ending.
class AssetNames {
 public:
  void add(const std::vector<std::string>& assets) { names_.insert(assets.begin(), assets.end()); }
  bool empty() const { return names_.empty(); }
  std::size_t size() const { return names_.size(); }
  /// One of shown_assets.
  bool has(const std::string& shown) const;

 private:
  std::set<std::string> names_;
};

}  // namespace ds
