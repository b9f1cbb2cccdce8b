// SPDX-License-Identifier: Apache-2.0
// Models, materials and environments of which nothing says where they come from.
#include "manifests/check/check.h"
#include "manifests/shown_assets.h"

#include <set>

namespace ds {
namespace {

void check_sources(const CheckInput& input, CheckReport& report) {
  AssetNames sourced;
  for (const SourceRecord& source : input.dataset.sources)
    sourced.add(source.assets);
  std::set<std::string> assets, without;
  std::vector<std::string> images;
  for (const ImageRecord& image : input.images) {
    bool whole = true;
    for (const std::string& asset : shown_assets(image, input.dataset)) {
      assets.insert(asset);
      if (sourced.has(asset)) continue;
      without.insert(asset);
      whole = false;
    }
    if (!whole) images.push_back(image.id);
  }
  report.add(CheckLevel::note, "models and scenes have no source beside them",
             {without.begin(), without.end()}, assets.size(),
             "a SOURCE file in their folder or the one above: whence they are, an address best",
             sourced.empty() ? std::vector<std::string>() : images);
}

}  // namespace

Check sources_check() {
  return {"sources", "assets of which nothing says where they come from", check_sources};
}

}  // namespace ds
