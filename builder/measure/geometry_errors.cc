// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/geometry_errors.h"

#include "tracer/base/error.h"

#include <cmath>

namespace ds {
namespace {

/// Sums of one pixel's rays.
struct PixelSums {
  int model = 0, hits = 0;
  double depth = 0;
};

PixelSums sums_of(const Geometry& geometry, int factor, int x, int y) {
  PixelSums sums;
  for (int row = y * factor; row < (y + 1) * factor; ++row)
    for (int column = x * factor; column < (x + 1) * factor; ++column) {
      const std::size_t i =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(geometry.width) +
          static_cast<std::size_t>(column);
      sums.model += geometry.mask[i] != 0 ? 1 : 0;
      if (geometry.depth[i] <= 0) continue;
      ++sums.hits;
      sums.depth += double{geometry.depth[i]};
    }
  return sums;
}

}  // namespace

Coverage coverage_of(const Geometry& geometry, int factor) {
  DS_ASSERT(factor >= 1 && geometry.width % factor == 0 && geometry.height % factor == 0);
  Coverage coverage{geometry.width / factor, geometry.height / factor, {}, {}, {}};
  const double rays = double(factor) * factor;
  for (int y = 0; y < coverage.height; ++y)
    for (int x = 0; x < coverage.width; ++x) {
      const PixelSums sums = sums_of(geometry, factor, x, y);
      coverage.model.push_back(static_cast<float>(sums.model / rays));
      coverage.hits.push_back(static_cast<float>(sums.hits / rays));
      coverage.depth.push_back(sums.hits > 0 ? static_cast<float>(sums.depth / sums.hits) : 0.0f);
    }
  return coverage;
}

GeometryErrors geometry_errors(const Coverage& found, const Coverage& reference) {
  DS_ASSERT(found.width == reference.width && found.height == reference.height);
  DS_ASSERT(!found.model.empty());
  GeometryErrors errors;
  double depths = 0;
  for (std::size_t i = 0; i < found.model.size(); ++i) {
    const double difference = double{found.model[i]} - double{reference.model[i]};
    errors.mask_rms += difference * difference;
    errors.mask_wrong += (found.model[i] >= 0.5f) != (reference.model[i] >= 0.5f) ? 1 : 0;
    if (reference.hits[i] < 1 || found.hits[i] <= 0) continue;
    const double relative = double{found.depth[i]} / double{reference.depth[i]} - 1;
    errors.depth_rms += relative * relative;
    ++depths;
  }
  const double pixels = static_cast<double>(found.model.size());
  errors.mask_rms = std::sqrt(errors.mask_rms / pixels);
  errors.mask_wrong /= pixels;
  if (depths > 0) errors.depth_rms = std::sqrt(errors.depth_rms / depths);
  return errors;
}

}  // namespace ds
