// SPDX-License-Identifier: Apache-2.0
#include "manifests/export/outlines.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace ds {
namespace {

using Corner = std::array<int, 2>;
using Loop = std::vector<Corner>;

/// Directions by number: right, down, left, up.
constexpr int k_x[4] = {1, 0, -1, 0}, k_y[4] = {0, 1, 0, -1};

/// The edges between mask and not, each directed so that the mask is on its right (y runs down). Those that
/// leave a corner, as a bit for each direction.
class Edges {
 public:
  explicit Edges(const MaskPixels& mask)
      : mask_(mask),
        columns_(mask.width + 1),
        leaving_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(mask.height + 1),
                 0) {
    for (int y = 0; y < mask.height; ++y)
      for (int x = 0; x < mask.width; ++x) {
        if (!is_set(x, y)) continue;
        if (!is_set(x, y - 1)) at(x, y) |= 1U;
        if (!is_set(x + 1, y)) at(x + 1, y) |= 2U;
        if (!is_set(x, y + 1)) at(x + 1, y + 1) |= 4U;
        if (!is_set(x - 1, y)) at(x, y + 1) |= 8U;
      }
  }

  /// Takes the edges of the loop that leaves the corner.
  Loop take_loop(Corner from) {
    Loop loop;
    int before = -1;
    Corner c = from;
    do {
      std::uint8_t& leaving = at(c[0], c[1]);
      // As many edges leave a corner as reach it. Where two loops touch, to the right stays with the pixel.
      int direction = before < 0 ? 0 : (before + 1) % 4;
      while ((leaving & (1U << static_cast<unsigned>(direction))) == 0)
        direction = (direction + 3) % 4;
      leaving = static_cast<std::uint8_t>(leaving & ~(1U << static_cast<unsigned>(direction)));
      if (direction != before) loop.push_back(c);
      before = direction;
      c = {c[0] + k_x[direction], c[1] + k_y[direction]};
    } while (c != from);
    return loop;
  }

  std::vector<Loop> take_loops() {
    std::vector<Loop> loops;
    for (int y = 0; y <= mask_.height; ++y)
      for (int x = 0; x <= mask_.width; ++x)
        while (at(x, y) != 0)
          loops.push_back(take_loop({x, y}));
    return loops;
  }

 private:
  bool is_set(int x, int y) const {
    return x >= 0 && y >= 0 && x < mask_.width && y < mask_.height &&
           mask_.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(mask_.width) +
                        static_cast<std::size_t>(x)] != 0;
  }
  std::uint8_t& at(int x, int y) {
    return leaving_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(x)];
  }
  const MaskPixels& mask_;
  int columns_;
  std::vector<std::uint8_t> leaving_;
};

double squared(Corner a, Corner b) {
  const double x = a[0] - b[0], y = a[1] - b[1];
  return x * x + y * y;
}

/// Puts the loop into the polygon where they are nearest, there and back.
void tie_in(Loop& polygon, const Loop& loop) {
  std::size_t from = 0, to = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i)
    for (std::size_t j = 0; j < loop.size(); ++j)
      if (const double distance = squared(polygon[i], loop[j]); distance < nearest) {
        nearest = distance;
        from = i;
        to = j;
      }
  Loop detour;
  for (std::size_t j = 0; j <= loop.size(); ++j)
    detour.push_back(loop[(to + j) % loop.size()]);
  detour.push_back(polygon[from]);
  polygon.insert(polygon.begin() + static_cast<std::ptrdiff_t>(from) + 1, detour.begin(),
                 detour.end());
}

}  // namespace

std::vector<Corner> outline_of(const MaskPixels& mask) {
  std::vector<Loop> loops = Edges(mask).take_loops();
  if (loops.empty()) return {};
  // The largest first, which others then lie near.
  std::stable_sort(loops.begin(), loops.end(),
                   [](const Loop& a, const Loop& b) { return a.size() > b.size(); });
  Loop polygon = loops.front();
  for (std::size_t i = 1; i < loops.size(); ++i)
    tie_in(polygon, loops[i]);
  return polygon;
}

}  // namespace ds
