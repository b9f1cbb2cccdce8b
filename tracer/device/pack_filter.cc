// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/scene_pack.h"
#include "tracer/kernels/all_nodes.h"

#include <vector>

namespace ds {
namespace {

/// Blackman-Harris window (Harris 1978, 4-term, -92 dB) at x in [0, 1], 0.5 being its middle.
double blackman_harris(double x) {
  // The kernels' cosine, not libm's: the table is in every pixel, so its bits must be the same
  // everywhere.
  const auto cosine = [&](double k) {
    return double{kernels::sin_cos_turns(static_cast<float>(k * x)).cos};
  };
  return 0.35875 - 0.48829 * cosine(1) + 0.14128 * cosine(2) - 0.01168 * cosine(3);
}

}  // namespace

std::uint32_t pack_filter(float filter_width, Words& tables) {
  const std::uint32_t offset = tables.offset();
  constexpr std::size_t steps = 4096;
  std::vector<double> cumulative(steps + 1, 0.0);
  for (std::size_t i = 0; i < steps; ++i) {
    const double weight = filter_width > 0 ? blackman_harris((double(i) + 0.5) / steps) : 1.0;
    cumulative[i + 1] = cumulative[i] + (weight > 0 ? weight : 0.0);
  }
  const double width = filter_width > 0 ? double{filter_width} : 1.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i <= kernels::k_filter_size; ++i) {
    const double target = cumulative[steps] * double(i) / double(kernels::k_filter_size);
    while (at + 1 < steps && cumulative[at + 1] < target)
      ++at;
    const double step = cumulative[at + 1] - cumulative[at];
    const double fraction = step > 0 ? (target - cumulative[at]) / step : 0.0;
    tables.add(static_cast<float>(((double(at) + fraction) / steps - 0.5) * width));
  }
  return offset;
}

}  // namespace ds
