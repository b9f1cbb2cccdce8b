// SPDX-License-Identifier: Apache-2.0
// What the splits share: one mesh under two names, as it is once normalised, by the model's part of the
// render key (which counts uvs and colours too where the material reads them); materials, environments and
// views, which may be meant.
#include "manifests/check/check.h"
#include "tracer/base/error.h"
#include "tracer/scene/mesh_shape.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <vector>

namespace ds {
namespace {

constexpr Threshold k_leaks_near{
    "leaks_near_shape",
    0.03,
    {.least = 0},
    "How alike the shapes of two models in two splits may be, whichever way they are turned, "
    "scaled, mirrored "
    "or cut into triangles (shape_distance): see Checks. 0: they are not compared"};

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

/// A model with its shape; copies that are equal are found by their hash.
struct Shaped {
  std::string_view shape, model, split;
  Hash128 geometry;
};

/// Sorted by shape and so by its first number, beyond which none is near.
std::vector<Shaped> shaped_models(const CheckInput& input) {
  std::vector<Shaped> models;
  const std::string* last = nullptr;
  for (const ImageRecord& image : input.images) {
    if (last != nullptr && *last == image.model) continue;
    last = &image.model;
    if (const auto at = input.dataset.shapes.find(image.model); at != input.dataset.shapes.end())
      models.push_back({at->second, image.model, image.split, image.parts[0]});
  }
  std::sort(models.begin(), models.end(), [](const Shaped& a, const Shaped& b) {
    return std::tie(a.shape, a.model) < std::tie(b.shape, b.model);
  });
  return models;
}

void check_shapes(const CheckInput& input, CheckReport& report) {
  const double near = input.threshold(k_leaks_near);
  if (near == 0) return;
  const std::vector<Shaped> models = shaped_models(input);
  std::vector<std::string> pairs;
  std::set<std::string_view> concerned;
  for (std::size_t i = 0; i < models.size(); ++i)
    for (std::size_t j = i + 1; j < models.size(); ++j) {
      const Shaped &a = models[i], &b = models[j];
      if (first_shape_number(b.shape) - first_shape_number(a.shape) > near) break;
      if (a.split == b.split || a.geometry == b.geometry || shape_distance(a.shape, b.shape) > near)
        continue;
      pairs.push_back(fmt::format("{} ({}), {} ({})", a.model, a.split, b.model, b.split));
      concerned.insert({a.model, b.model});
    }
  report.add(CheckLevel::warning,
             "pairs of models in two splits have nearly one shape, as turned, scaled or remeshed "
             "copies have",
             pairs, models.size(), "keep all copies of a model in one split",
             ids_where(input.images,
                       [&](const ImageRecord& image) { return concerned.contains(image.model); }));
}

void check_meshes(const CheckInput& input, CheckReport& report) {
  std::map<Hash128, std::map<std::string, std::string>> geometries;  // split, model
  for (const ImageRecord& image : input.images)
    geometries[image.parts[0]].emplace(image.split, image.model);
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
}

/// A model is the same where its name and its file's box are.
void check_distractor_models(const CheckInput& input, CheckReport& report) {
  std::map<std::string_view, const ImageRecord*> models;
  for (const ImageRecord& image : input.images)
    models.emplace(image.model, &image);
  const auto of_another = [&](const ImageRecord& image, const ObjectRecord& object) {
    const auto at = models.find(object.model);
    return at != models.end() && at->second->split != image.split && at->second->pose &&
           at->second->pose->model_box == object.pose.model_box;
  };
  std::uint64_t with_objects = 0;
  std::vector<std::string> leaking;
  for (const ImageRecord& image : input.images) {
    with_objects += image.objects.empty() ? 0U : 1U;
    if (std::any_of(image.objects.begin(), image.objects.end(),
                    [&](const ObjectRecord& object) { return of_another(image, object); }))
      leaking.push_back(image.id);
  }
  report.add(CheckLevel::error, "images show a model of another split as a distractor", leaking,
             with_objects, "distractors.dir = \"{models}\" takes those of an image's own split");
}

void check_leaks(const CheckInput& input, CheckReport& report) {
  std::set<std::string> all_splits;
  for (const ImageRecord& image : input.images)
    all_splits.insert(image.split);
  if (all_splits.size() < 2) {
    report.say(CheckLevel::note, "the dataset has one split only, nothing can leak",
               "classes.train and classes.test, or classes.split");
    return;
  }
  // Where materials, environments or views are split, models are meant to be in both.
  const std::string by = input.setting("classes.split.by");
  if (by.empty() || by == "\"model\"") {
    check_meshes(input, report);
    check_distractor_models(input, report);
    check_shapes(input, report);
  } else {
    check_shared(input, report, "models", &ImageRecord::model);
  }
  check_shared(input, report, "materials", &ImageRecord::material);
  check_shared(input, report, "environments", &ImageRecord::environment);
  check_shared(input, report, "views", &ImageRecord::view);
}

}  // namespace

Check leaks_check() {
  return {"leaks",
          "what the splits share: meshes, materials, environments, views",
          check_leaks,
          {k_leaks_near}};
}

}  // namespace ds
