// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/ssim.h"

#include "builder/measure/channel.h"
#include "tracer/base/error.h"
#include "tracer/base/luminance.h"

#include <cstdint>

namespace ds {
namespace {

constexpr int k_radius = 5;
constexpr double k_sigma = 1.5;
constexpr double k_c1 = 0.01 * 255 * 0.01 * 255;
constexpr double k_c2 = 0.03 * 255 * 0.03 * 255;

Channel luma(const BytePicture& picture) {
  DS_ASSERT(picture.channels == 3);
  Channel channel(picture.width, picture.height);
  const std::uint8_t* p = picture.pixels.data();
  for (double& value : channel.values) {
    value = luminance(Vec3d{double(p[0]), double(p[1]), double(p[2])});
    p += 3;
  }
  return channel;
}

Channel product(const Channel& a, const Channel& b) {
  Channel channel = a;
  for (std::size_t i = 0; i < channel.values.size(); ++i)
    channel.values[i] *= b.values[i];
  return channel;
}

}  // namespace

std::optional<double> ssim(const BytePicture& x, const BytePicture& y) {
  DS_ASSERT(x.width == y.width && x.height == y.height);
  if (x.width <= 2 * k_radius || x.height <= 2 * k_radius) return std::nullopt;
  const Taps taps = normalised(gaussian_taps(k_sigma, k_radius));
  const auto blur = [&](const Channel& channel) { return filtered(channel, taps, taps); };
  const Channel a = luma(x);
  const Channel b = luma(y);
  const Channel mean_a = blur(a);
  const Channel mean_b = blur(b);
  const Channel square_a = blur(product(a, a));
  const Channel square_b = blur(product(b, b));
  const Channel cross = blur(product(a, b));
  double sum = 0;
  // Windows that reach over the border are left out.
  for (int row = k_radius; row < x.height - k_radius; ++row)
    for (int column = k_radius; column < x.width - k_radius; ++column) {
      const double m = mean_a.at(column, row);
      const double n = mean_b.at(column, row);
      const double variance_a = square_a.at(column, row) - m * m;
      const double variance_b = square_b.at(column, row) - n * n;
      const double covariance = cross.at(column, row) - m * n;
      sum += (2 * m * n + k_c1) * (2 * covariance + k_c2) /
             ((m * m + n * n + k_c1) * (variance_a + variance_b + k_c2));
    }
  return sum / (double(x.width - 2 * k_radius) * double(x.height - 2 * k_radius));
}

}  // namespace ds
