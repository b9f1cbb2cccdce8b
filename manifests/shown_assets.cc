// SPDX-License-Identifier: Apache-2.0
#include "manifests/shown_assets.h"

namespace ds {

std::vector<std::string> shown_assets(const ImageRecord& image, const DatasetRecord& dataset) {
  std::vector<std::string> assets;
  const auto add = [&](const std::string& model, const std::string& material) {
    assets.push_back("models/" + model);
    if (!dataset.own_materials.contains(model)) assets.push_back("materials/" + material);
  };
  add(image.model, image.material);
  assets.push_back("environments/" + image.environment);
  for (const ObjectRecord& object : image.objects)
    add(object.model, object.material);
  return assets;
}

bool AssetNames::has(const std::string& shown) const {
  if (names_.contains(shown)) return true;
  const auto at = names_.lower_bound(shown + ".");
  return at != names_.end() && at->starts_with(shown + ".");
}

}  // namespace ds
