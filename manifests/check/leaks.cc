// SPDX-License-Identifier: Apache-2.0
// What the splits share: one mesh under two names, as it is once normalised, by the model's part of the
// render key (which counts uvs and colours too where the material reads them); materials, environments and
// views, which may be meant.
#include "manifests/check/check.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <map>
#include <set>

namespace ds {
namespace {

using Field = std::string ImageRecord::*;

void check_shared(const CheckInput& input, CheckReport& report, const char* name, Field field) {
  std::map<std::string, std::set<std::string>> splits;
  for (const ImageRecord& image : input.images)
    splits[image.*field].insert(image.split);
  const auto shared = static_cast<std::uint64_t>(std::count_if(
      splits.begin(), splits.end(), [](const auto& entry) { return entry.second.size() > 1; }));
  if (shared > 0)
    report.say(CheckLevel::note,
               fmt::format("{} of {} {} are in more than one split", shared, splits.size(), name));
}

void check_leaks(const CheckInput& input, CheckReport& report) {
  std::set<std::string> all_splits;
  std::map<Hash128, std::map<std::string, std::string>> geometries;  // split, model
  std::map<std::string, std::set<std::string>> models;
  for (const ImageRecord& image : input.images) {
    all_splits.insert(image.split);
    geometries[image.parts[0]].emplace(image.split, image.model);
    models[image.model].insert(image.split);
  }
  if (all_splits.size() < 2) {
    report.say(CheckLevel::note, "the dataset has one split only, nothing can leak",
               "classes.train and classes.test, or classes.split");
    return;
  }
  std::vector<std::string> same;
  for (const auto& [geometry, by_split] : geometries) {
    if (by_split.size() < 2) continue;
    std::string names;
    for (const auto& [split, model] : by_split)
      names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", model, split);
    same.push_back(names);
  }
  report.add(CheckLevel::error, "models are the same mesh in two splits", same, geometries.size(),
             "keep all copies of a model in one split",
             ids_where(input.images, [&](const ImageRecord& image) {
               return geometries.at(image.parts[0]).size() > 1;
             }));
  check_shared(input, report, "materials", &ImageRecord::material);
  check_shared(input, report, "environments", &ImageRecord::environment);
  check_shared(input, report, "views", &ImageRecord::view);
}

}  // namespace

Check leaks_check() {
  return {"leaks", "what the splits share: meshes, materials, environments, views", check_leaks};
}

}  // namespace ds
