// SPDX-License-Identifier: Apache-2.0
// One shape under two class labels: whatever is learnt of it, one of them is wrong.
#include "manifests/check/check.h"
#include "manifests/check/divisions.h"
#include "manifests/check/meshes.h"
#include "tracer/base/error.h"

#include <map>
#include <set>

namespace ds {
namespace {

void check_meshes(const CheckInput& input, CheckReport& report, const Meshes& meshes) {
  std::map<std::size_t, std::map<std::string, std::string>> by_mesh;  // class, one of its models
  for (const ImageRecord& image : input.images)
    if (!image.class_path.empty())
      by_mesh[meshes.of(image.model)].emplace(image.class_path, image.model);
  std::vector<std::string> same;
  for (const auto& [mesh, by_class] : by_mesh) {
    if (by_class.size() < 2) continue;
    std::vector<std::string> names, models;
    for (const auto& [class_path, model] : by_class) {
      names.push_back(name_in(model, class_path));
      models.push_back(model);
    }
    same.push_back(fmt::format("{}{}", fmt::join(names, ", "), meshes.doubt(models)));
  }
  report.add(CheckLevel::error, "models are the same mesh in two classes", same, by_mesh.size(),
             "give it one class, or leave a copy out",
             ids_where(input.images, [&](const ImageRecord& image) {
               const auto at = by_mesh.find(meshes.of(image.model));
               return at != by_mesh.end() && at->second.size() > 1;
             }));
}

void check_shapes(const CheckInput& input, CheckReport& report, const Meshes& meshes) {
  std::map<std::string, std::uint64_t> models;
  for (const ImageRecord* image : shaped_models(input))
    if (!image->class_path.empty()) ++models[image->class_path];
  std::vector<std::string> pairs;
  std::set<std::string_view> concerned;
  for (const auto& [a, b] : near_pairs(input, meshes)) {
    if (a->class_path.empty() || b->class_path.empty() || a->class_path == b->class_path) continue;
    pairs.push_back(
        fmt::format("{}, {}", name_in(a->model, a->class_path), name_in(b->model, b->class_path)));
    concerned.insert({a->model, b->model});
  }
  report.add(CheckLevel::warning,
             "pairs of models in two classes have nearly one shape, as turned, scaled or remeshed "
             "copies have",
             pairs, pairs_apart(models), "give both one class, or leave one out",
             ids_where(input.images,
                       [&](const ImageRecord& image) { return concerned.contains(image.model); }));
}

void check_labels(const CheckInput& input, CheckReport& report) {
  const Meshes meshes(input.images, input.dataset.shapes);
  check_meshes(input, report, meshes);
  check_shapes(input, report, meshes);
}

}  // namespace

Check labels_check() {
  return {"labels", "the same mesh, or nearly one shape, in two classes", check_labels};
}

}  // namespace ds
