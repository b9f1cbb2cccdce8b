// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ds {

/// Cells of a plane whose centres triangles cover. Cell (x, y) has its centre at (x + 0.5, y + 0.5); those
/// from `first_x`, `first_y` on are held.
class Canvas {
 public:
  Canvas(int first_x, int first_y, int width, int height)
      : first_x_(first_x),
        first_y_(first_y),
        width_(width),
        height_(height),
        covered_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0) {}

  /// Corners must be finite. What is beyond the canvas is left out.
  void cover(std::array<double, 2> a, std::array<double, 2> b, std::array<double, 2> c);

  /// Calls visit(x, y) for each covered cell, row by row.
  template <typename Visit>
  void visit(const Visit& visit) const {
    std::size_t at = 0;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x, ++at)
        if (covered_[at] != 0) visit(x + first_x_, y + first_y_);
  }

 private:
  int first_x_, first_y_, width_, height_;
  std::vector<std::uint8_t> covered_;
};

}  // namespace ds
