// SPDX-License-Identifier: Apache-2.0
// What the splits share, and the folds: one mesh under two names, and models of nearly one shape; materials,
// environments and views, which may be meant.
#include "manifests/check/check.h"
#include "manifests/check/divisions.h"
#include "manifests/check/meshes.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <vector>

namespace ds {
namespace {

using Field = std::string ImageRecord::*;

void check_shared(const CheckInput& input, CheckReport& report, const Division& division,
                  const char* name, Field field) {
  std::map<std::string, std::set<std::string>> parts;
  for (const ImageRecord& image : input.images)
    if (auto part = division.part_of(image)) parts[image.*field].insert(*std::move(part));
  const auto shared = static_cast<std::uint64_t>(std::count_if(
      parts.begin(), parts.end(), [](const auto& entry) { return entry.second.size() > 1; }));
  if (shared > 0)
    report.say(CheckLevel::note, fmt::format("{} of {} {} are in more than one {}", shared,
                                             parts.size(), name, division.one));
}

void check_shapes(const CheckInput& input, CheckReport& report, const Division& division,
                  const std::vector<ModelPair>& near) {
  std::map<std::string, std::uint64_t> models;
  for (const ImageRecord* image : shaped_models(input))
    if (const auto part = division.part_of(*image)) ++models[*part];
  std::vector<std::string> pairs;
  std::set<std::string_view> concerned;
  for (const auto& [a, b] : near) {
    if (!division.parts(*a, *b)) continue;
    pairs.push_back(fmt::format("{}, {}", name_in(a->model, *division.part_of(*a)),
                                name_in(b->model, *division.part_of(*b))));
    concerned.insert({a->model, b->model});
  }
  report.add(CheckLevel::warning,
             fmt::format("pairs of models in two {} have nearly one shape, as turned, scaled or "
                         "remeshed copies have",
                         division.many),
             pairs, pairs_apart(models),
             fmt::format("keep all copies of a model in one {}", division.one),
             ids_where(input.images,
                       [&](const ImageRecord& image) { return concerned.contains(image.model); }));
}

void check_meshes(const CheckInput& input, CheckReport& report, const Division& division,
                  const Meshes& meshes) {
  std::map<std::size_t, std::map<std::string, std::string>> by_mesh;  // part, model
  for (const ImageRecord& image : input.images)
    if (auto part = division.part_of(image))
      by_mesh[meshes.of(image.model)].emplace(*std::move(part), image.model);
  std::vector<std::string> same;
  for (const auto& [mesh, by_part] : by_mesh) {
    if (by_part.size() < 2) continue;
    std::vector<std::string> names, models;
    for (const auto& [part, model] : by_part) {
      names.push_back(name_in(model, part));
      models.push_back(model);
    }
    same.push_back(fmt::format("{}{}", fmt::join(names, ", "), meshes.doubt(models)));
  }
  report.add(CheckLevel::error, fmt::format("models are the same mesh in two {}", division.many),
             same, by_mesh.size(),
             fmt::format("keep all copies of a model in one {}", division.one),
             ids_where(input.images, [&](const ImageRecord& image) {
               return division.part_of(image) && by_mesh.at(meshes.of(image.model)).size() > 1;
             }));
}

/// A model is the same where its name and its file's box are.
void check_distractor_models(const CheckInput& input, CheckReport& report,
                             const Division& division) {
  std::map<std::string_view, const ImageRecord*> models;
  for (const ImageRecord& image : input.images)
    models.emplace(image.model, &image);
  const auto of_another = [&](const ImageRecord& image, const ObjectRecord& object) {
    const auto at = models.find(object.model);
    return at != models.end() && division.parts(*at->second, image) && at->second->pose &&
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
  report.add(CheckLevel::error,
             fmt::format("images show a model of another {} as a distractor", division.one),
             leaking, with_objects,
             fmt::format("distractors.dir = \"{{models}}\" takes those of an image's own {}",
                         division.one));
}

void check_leaks(const CheckInput& input, CheckReport& report) {
  const std::vector<Division> divisions = divisions_of(input.images);
  if (divisions.empty()) {
    report.say(CheckLevel::note, "the dataset has one split only, nothing can leak",
               "classes.train and classes.test, or classes.split");
    return;
  }
  // Where materials, environments or views are split, models are meant to be in both.
  const std::string by = split_by(input);
  const bool by_model = by == "model" || by == "class";
  const Meshes meshes(input.images, input.dataset.shapes);
  const std::vector<ModelPair> near =
      by_model ? near_pairs(input, meshes) : std::vector<ModelPair>();
  for (const Division& division : divisions) {
    if (by_model) {
      check_meshes(input, report, division, meshes);
      check_distractor_models(input, report, division);
      check_shapes(input, report, division, near);
    } else {
      check_shared(input, report, division, "models", &ImageRecord::model);
    }
    check_shared(input, report, division, "materials", &ImageRecord::material);
    check_shared(input, report, division, "environments", &ImageRecord::environment);
    check_shared(input, report, division, "views", &ImageRecord::view);
  }
}

}  // namespace

Check leaks_check() {
  return {"leaks",
          "what the splits share, or the folds: meshes, materials, environments, views",
          check_leaks,
          {k_leaks_near}};
}

}  // namespace ds
