// SPDX-License-Identifier: Apache-2.0
// One shape under two class labels: whatever is learnt of it, one of them is wrong. Meshes are told apart by the
// model's part of the render key, as in leaks.cc.
#include "manifests/check/check.h"
#include "tracer/base/error.h"

#include <map>

namespace ds {
namespace {

void check_labels(const CheckInput& input, CheckReport& report) {
  std::map<Hash128, std::map<std::string, std::string>> meshes;  // class, one of its models
  for (const ImageRecord& image : input.images)
    if (!image.class_path.empty()) meshes[image.parts[0]].emplace(image.class_path, image.model);
  std::vector<std::string> same;
  for (const auto& [mesh, by_class] : meshes) {
    if (by_class.size() < 2) continue;
    std::string names;
    for (const auto& [class_path, model] : by_class)
      names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", model, class_path);
    same.push_back(names);
  }
  report.add(CheckLevel::error, "models are the same mesh in two classes", same, meshes.size(),
             "give it one class, or leave a copy out",
             ids_where(input.images, [&](const ImageRecord& image) {
               const auto at = meshes.find(image.parts[0]);
               return at != meshes.end() && at->second.size() > 1;
             }));
}

}  // namespace

Check labels_check() {
  return {"labels", "the same mesh in two classes", check_labels};
}

}  // namespace ds
