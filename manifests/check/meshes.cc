// SPDX-License-Identifier: Apache-2.0
#include "manifests/check/meshes.h"

#include "tracer/base/error.h"
#include "tracer/scene/mesh_shape.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

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

struct Shaped {
  ShapeNumbers numbers;
  std::size_t mesh;
  const ImageRecord* image;
};

/// Shapes by three of their numbers, those that vary most, in cells as wide as what is near: what is near a
/// shape is in its cell or one beside it, so that a dataset's check takes no time of its models' square.
class ShapeGrid {
 public:
  ShapeGrid(const std::vector<Shaped>& shapes, double near)
      : shapes_(shapes), width_(near * k_shape_steps + 1) {
    std::array<std::pair<double, std::size_t>, std::tuple_size_v<ShapeNumbers>> spreads;
    for (std::size_t n = 0; n < spreads.size(); ++n)
      spreads.at(n) = {-variance_of(n), n};
    std::sort(spreads.begin(), spreads.end());
    for (std::size_t k = 0; k < numbers_.size(); ++k)
      numbers_.at(k) = spreads.at(k).second;
    for (std::size_t i = 0; i < shapes.size(); ++i)
      cells_[cell_of(i)].push_back(i);
  }

  /// Those that may be near the i-th and come behind it, in order.
  std::vector<std::size_t> behind(std::size_t i) const {
    std::vector<std::size_t> found;
    const Cell own = cell_of(i);
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const auto cell = cells_.find({own[0] + x, own[1] + y, own[2] + z});
          if (cell == cells_.end()) continue;
          const auto& shapes = cell->second;
          found.insert(found.end(), std::upper_bound(shapes.begin(), shapes.end(), i),
                       shapes.end());
        }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  using Cell = std::array<long, 3>;

  Cell cell_of(std::size_t i) const {
    Cell cell{};
    for (std::size_t k = 0; k < cell.size(); ++k)
      cell.at(k) = static_cast<long>(shapes_[i].numbers.at(numbers_.at(k)) / width_);
    return cell;
  }
  double variance_of(std::size_t number) const {
    double sum = 0, squares = 0;
    for (const Shaped& shape : shapes_) {
      const double value = shape.numbers.at(number);
      sum += value;
      squares += value * value;
    }
    const auto count = static_cast<double>(shapes_.size());
    return squares - sum * sum / std::max(count, 1.0);
  }

  const std::vector<Shaped>& shapes_;
  double width_;
  std::array<std::size_t, 3> numbers_{};
  std::map<Cell, std::vector<std::size_t>> cells_;
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
  std::vector<Shaped> models;
  for (const ImageRecord* image : shaped_models(input))
    if (const auto numbers = shape_numbers(input.dataset.shapes.at(image->model)))
      models.push_back({*numbers, meshes.of(image->model), image});
  std::sort(models.begin(), models.end(), [](const Shaped& a, const Shaped& b) {
    return std::tie(a.numbers, a.image->model) < std::tie(b.numbers, b.image->model);
  });
  const ShapeGrid grid(models, near);
  std::vector<ModelPair> pairs;
  for (std::size_t i = 0; i < models.size(); ++i)
    for (const std::size_t j : grid.behind(i)) {
      const Shaped &a = models[i], &b = models[j];
      if (a.mesh != b.mesh && shape_distance(a.numbers, b.numbers) <= near)
        pairs.push_back({a.image, b.image});
    }
  return pairs;
}

}  // namespace ds
