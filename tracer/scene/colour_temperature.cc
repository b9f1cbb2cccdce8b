// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/colour_temperature.h"

#include "tracer/base/error.h"

#include <algorithm>

namespace ds {
namespace {

double cubic(double x, double a3, double a2, double a1, double a0) {
  return ((a3 * x + a2) * x + a1) * x + a0;
}

}  // namespace

Vec3d black_body_colour(double temperature_k) {
  DS_ASSERT(temperature_k >= 1667 && temperature_k <= 25000);
  const double per_kk = 1000 / temperature_k;
  const double x = temperature_k <= 4000
                       ? cubic(per_kk, -0.2661239, -0.2343589, 0.8776956, 0.179910)
                       : cubic(per_kk, -3.0258469, 2.1070379, 0.2226347, 0.240390);
  const double y =
      temperature_k <= 2222   ? cubic(x, -1.1063814, -1.34811020, 2.18555832, -0.20219683)
      : temperature_k <= 4000 ? cubic(x, -0.9549476, -1.37418593, 2.09137015, -0.16748867)
                              : cubic(x, 3.0817580, -5.87338670, 3.75112997, -0.37001483);
  const Vec3d xyz{x / y, 1, (1 - x - y) / y};
  // XYZ to linear Rec.709: IEC 61966-2-1.
  const Vec3d rgb{dot(Vec3d{3.2404542, -1.5371385, -0.4985314}, xyz),
                  dot(Vec3d{-0.9692660, 1.8760108, 0.0415560}, xyz),
                  dot(Vec3d{0.0556434, -0.2040259, 1.0572252}, xyz)};
  const Vec3d inside{std::max(rgb.x, 0.0), std::max(rgb.y, 0.0), std::max(rgb.z, 0.0)};
  return inside * (1 / dot(Vec3d{0.2126729, 0.7151522, 0.0721750}, inside));
}

}  // namespace ds
