// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/channel.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ds {
namespace {

int radius_of(const Taps& taps) {
  return static_cast<int>(taps.size() / 2);
}

}  // namespace

Taps gaussian_taps(double sigma, int radius) {
  Taps taps;
  for (int x = -radius; x <= radius; ++x)
    taps.push_back(std::exp(-double(x) * x / (2 * sigma * sigma)));
  return taps;
}

Taps normalised(Taps taps) {
  const double sum = std::accumulate(taps.begin(), taps.end(), 0.0);
  for (double& tap : taps)
    tap /= sum;
  return taps;
}

Channel filtered(const Channel& channel, const Taps& across, const Taps& down) {
  Channel half(channel.width, channel.height);
  const int rx = radius_of(across);
  const double* const tap_x = across.data() + rx;
  for (int y = 0; y < channel.height; ++y)
    for (int x = 0; x < channel.width; ++x) {
      double sum = 0;
      for (int i = -rx; i <= rx; ++i)
        sum += tap_x[i] * channel.at(std::clamp(x + i, 0, channel.width - 1), y);
      half.at(x, y) = sum;
    }
  Channel whole(channel.width, channel.height);
  const int ry = radius_of(down);
  const double* const tap_y = down.data() + ry;
  for (int i = -ry; i <= ry; ++i)
    for (int y = 0; y < channel.height; ++y) {
      const int from = std::clamp(y + i, 0, channel.height - 1);
      for (int x = 0; x < channel.width; ++x)
        whole.at(x, y) += tap_y[i] * half.at(x, from);
    }
  return whole;
}

}  // namespace ds
