// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/film_error.h"

#include "tracer/base/error.h"

#include <cmath>

namespace ds {

std::optional<double> relative_error(std::span<const float> rgb, std::span<const float> halves,
                                     int spp) {
  DS_ASSERT(rgb.size() == 3 * halves.size());
  if (spp < 2) return std::nullopt;
  double luminance = 0;
  double variance = 0;
  for (std::size_t i = 0; i < halves.size(); ++i) {
    const double y = 0.2126 * double{rgb[3 * i]} + 0.7152 * double{rgb[3 * i + 1]} +
                     0.0722 * double{rgb[3 * i + 2]};
    // An odd count leaves the even half one sample longer: its surplus is taken out as one mean.
    const double difference = double{halves[i]} - (spp % 2 == 1 ? y : 0.0);
    luminance += y;
    variance += (difference / spp) * (difference / spp);
  }
  const double pixels = static_cast<double>(halves.size());
  return luminance > 0 ? std::sqrt(variance / pixels) / (luminance / pixels) : 0.0;
}

}  // namespace ds
