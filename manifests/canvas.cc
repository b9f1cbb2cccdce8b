// SPDX-License-Identifier: Apache-2.0
#include "manifests/canvas.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ds {
namespace {

/// The first cell whose centre is not before the place.
int to_index(double place, int most) {
  return static_cast<int>(std::clamp(std::ceil(place - 0.5), 0.0, double(most)));
}

}  // namespace

void Canvas::cover(std::array<double, 2> a, std::array<double, 2> b, std::array<double, 2> c) {
  const int first = to_index(std::min({a[1], b[1], c[1]}) - first_y_, height_);
  const int last = to_index(std::max({a[1], b[1], c[1]}) - first_y_, height_);
  for (int y = first; y < last; ++y) {
    const double at = y + 0.5 + first_y_;
    double from = 1e300, to = -1e300;
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      if ((p[1] <= at) == (q[1] <= at)) continue;
      const double x = p[0] + (at - p[1]) / (q[1] - p[1]) * (q[0] - p[0]);
      from = std::min(from, x);
      to = std::max(to, x);
    }
    if (from > to) continue;
    const int x0 = to_index(from - first_x_, width_), x1 = to_index(to - first_x_, width_);
    const auto row = covered_.begin() + static_cast<std::ptrdiff_t>(y) * width_;
    std::fill(row + x0, row + x1, std::uint8_t{1});
  }
}

}  // namespace ds
