// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace ds {

/// One channel of a picture in double; row 0 is the top.
struct Channel {
  int width = 0, height = 0;
  std::vector<double> values;

  Channel(int columns, int rows)
      : width(columns),
        height(rows),
        values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}
  double& at(int x, int y) { return values[index(x, y)]; }
  double at(int x, int y) const { return values[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// Weights of a filter along one axis: 2 radius + 1 of them, the middle one for the pixel itself.
using Taps = std::vector<double>;

/// exp(-x^2 / (2 sigma^2)) for x = -radius .. radius, not normalised. sigma > 0.
Taps gaussian_taps(double sigma, int radius);
/// `taps` divided by their sum.
Taps normalised(Taps taps);

/// The correlation of a channel with the product of both filters: `across` along x, `down` along y.
/// Beyond the border the nearest pixel stands in.
Channel filtered(const Channel& channel, const Taps& across, const Taps& down);

}  // namespace ds
