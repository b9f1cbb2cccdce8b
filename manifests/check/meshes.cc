// SPDX-License-Identifier: Apache-2.0
#include "manifests/check/meshes.h"

#include "tracer/base/error.h"
#include "tracer/scene/mesh_shape.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace ds {
namespace {

/// Least and most of the box; -0 as 0, so that equal boxes are equal keys.
std::array<double, 6> key_of(const Box& box) {
  return {box.least.x + 0.0, box.least.y + 0.0, box.least.z + 0.0,
          box.most.x + 0.0,  box.most.y + 0.0,  box.most.z + 0.0};
}

/// Numbers that can be found to mean the same.
class Merged {
 public:
  std::size_t add() {
    above_.push_back(above_.size());
    return above_.back();
  }
  std::size_t top(std::size_t number) {
    while (above_[number] != number)
      number = above_[number] = above_[above_[number]];
    return number;
  }
  void merge(std::size_t a, std::size_t b) { above_[top(a)] = top(b); }

 private:
  std::vector<std::size_t> above_;
};

}  // namespace

Meshes::Meshes(const std::vector<ImageRecord>& images,
               const std::map<std::string, std::string>& shapes) {
  Merged merged, by_key;
  std::map<Hash128, std::size_t> by_part;
  std::map<std::tuple<std::string_view, std::array<double, 6>>, std::size_t> by_file;
  for (const ImageRecord& image : images) {
    const auto [model, is_new] = numbers_.try_emplace(image.model);
    if (is_new) {
      model->second = merged.add();
      by_key_.emplace(image.model, by_key.add());
    }
    const std::size_t met = by_part.try_emplace(image.parts[0], model->second).first->second;
    merged.merge(met, model->second);
    by_key.merge(met, model->second);
    const auto shape = shapes.find(image.model);
    if (!image.pose || shape == shapes.end() || shape->second.empty()) continue;
    const auto at =
        by_file.try_emplace({shape->second, key_of(image.pose->model_box)}, model->second).first;
    merged.merge(at->second, model->second);
  }
  std::map<std::size_t, std::size_t> tops;
  for (auto& [model, number] : numbers_)
    number = tops.try_emplace(merged.top(number), tops.size()).first->second;
  count_ = tops.size();
  for (auto& [model, number] : by_key_)
    number = by_key.top(number);
}

std::string Meshes::doubt(const std::vector<std::string>& models) const {
  const bool sure = std::all_of(models.begin(), models.end(), [&](const std::string& model) {
    return by_key_.at(model) == by_key_.at(models.front());
  });
  return sure ? "" : ": the same or mirrored";
}

std::size_t Meshes::of(const std::string& model) const {
  const auto at = numbers_.find(model);
  DS_ASSERT(at != numbers_.end());
  return at->second;
}

std::vector<const ImageRecord*> shaped_models(const CheckInput& input) {
  std::map<std::string_view, const ImageRecord*> models;
  for (const ImageRecord& image : input.images)
    if (input.dataset.shapes.contains(image.model)) models.try_emplace(image.model, &image);
  std::vector<const ImageRecord*> first;
  first.reserve(models.size());
  for (const auto& [model, image] : models)
    first.push_back(image);
  return first;
}

std::vector<ModelPair> near_pairs(const CheckInput& input, const Meshes& meshes) {
  const double near = input.threshold(k_leaks_near);
  if (near == 0) return {};
  struct Shaped {
    std::string_view shape;
    const ImageRecord* image;
  };
  // Sorted by shape and so by its first number, beyond which none is near.
  std::vector<Shaped> models;
  for (const ImageRecord* image : shaped_models(input))
    models.push_back({input.dataset.shapes.at(image->model), image});
  std::sort(models.begin(), models.end(), [](const Shaped& a, const Shaped& b) {
    return std::tie(a.shape, a.image->model) < std::tie(b.shape, b.image->model);
  });
  std::vector<ModelPair> pairs;
  for (std::size_t i = 0; i < models.size(); ++i)
    for (std::size_t j = i + 1; j < models.size(); ++j) {
      const Shaped &a = models[i], &b = models[j];
      if (first_shape_number(b.shape) - first_shape_number(a.shape) > near) break;
      if (meshes.of(a.image->model) == meshes.of(b.image->model)) continue;
      if (shape_distance(a.shape, b.shape) <= near) pairs.push_back({a.image, b.image});
    }
  return pairs;
}

}  // namespace ds
