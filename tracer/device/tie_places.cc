// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/tie_places.h"

#include "tracer/kernels/all_nodes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace ds {
namespace {

Box3 both(const Box3& a, const Box3& b) {
  return {
      {std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
      {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}

double half_surface(const Box3& box) {
  const Vec3d d = box.high - box.low;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

}  // namespace

bool meet(const Box3& a, const Box3& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

void TiePlaces::join_nearest() {
  std::size_t first = 0, second = 1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    for (std::size_t j = i + 1; j < boxes_.size(); ++j) {
      const double more = half_surface(both(boxes_[i], boxes_[j])) - half_surface(boxes_[i]) -
                          half_surface(boxes_[j]);
      if (more >= least) continue;
      least = more;
      first = i;
      second = j;
    }
  boxes_[first] = both(boxes_[first], boxes_[second]);
  boxes_.erase(boxes_.begin() + static_cast<std::ptrdiff_t>(second));
}

void TiePlaces::add(const Box3& added) {
  Box3 box = added;
  for (std::size_t i = 0; i < boxes_.size();) {
    if (!meet(boxes_[i], box)) {
      ++i;
      continue;
    }
    // The larger may meet one passed over.
    box = both(boxes_[i], box);
    boxes_.erase(boxes_.begin() + static_cast<std::ptrdiff_t>(i));
    i = 0;
  }
  boxes_.push_back(box);
  if (boxes_.size() > k_most_tie_places) join_nearest();
}

std::vector<TiePlace> TiePlaces::take() const {
  constexpr float k_far = std::numeric_limits<float>::infinity();
  const auto below = [](double v) {
    const auto rounded = static_cast<float>(v);
    return double{rounded} <= v ? rounded : std::nextafter(rounded, -k_far);
  };
  const auto above = [](double v) {
    const auto rounded = static_cast<float>(v);
    return double{rounded} >= v ? rounded : std::nextafter(rounded, k_far);
  };
  std::vector<TiePlace> places;
  for (const Box3& box : boxes_)
    places.push_back({{below(box.low.x), below(box.low.y), below(box.low.z)},
                      {above(box.high.x), above(box.high.y), above(box.high.z)}});
  return places;
}

}  // namespace ds
