// SPDX-License-Identifier: Apache-2.0
#include "manifests/diff/pixels.h"

#include "manifests/image_samples.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace ds {
namespace {

bool are_equal(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

std::string shape_of(const DecodedImage& image) {
  return fmt::format("{}x{}, {} channel{} of {}", image.width, image.height, image.channels,
                     image.channels == 1 ? "" : "s", sample_type_name(image.type));
}

std::size_t pixels_of(const DecodedImage& image) {
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

}  // namespace

std::string why_not_comparable(const DecodedImage& a, const DecodedImage& b) {
  const std::string one = shape_of(a), other = shape_of(b);
  return one == other ? "" : one + " and " + other;
}

PixelDifference pixel_difference(const DecodedImage& a, const DecodedImage& b) {
  DS_ASSERT(why_not_comparable(a, b).empty());
  const ImageSamples from(a), to(b);
  const auto channels = static_cast<std::size_t>(a.channels);
  PixelDifference found;
  found.of = pixels_of(a);
  double squares = 0;
  std::uint64_t finite = 0;
  for (std::size_t p = 0; p < found.of; ++p) {
    bool differs = false, is_finite = true;
    for (std::size_t c = 0; c < channels; ++c) {
      const double x = from[p * channels + c], y = to[p * channels + c];
      differs = differs || !are_equal(x, y);
      if (!std::isfinite(x) || !std::isfinite(y)) {
        is_finite = is_finite && are_equal(x, y);
        continue;
      }
      const double distance = std::abs(x - y);
      squares += distance * distance;
      ++finite;
      if (distance <= found.largest) continue;
      found.largest = distance;
      found.x = static_cast<int>(p % static_cast<std::size_t>(a.width));
      found.y = static_cast<int>(p / static_cast<std::size_t>(a.width));
    }
    found.pixels += differs ? 1U : 0U;
    found.not_finite += is_finite ? 0U : 1U;
  }
  if (finite > 0) found.rms = std::sqrt(squares / static_cast<double>(finite));
  return found;
}

BytePicture difference_picture(const DecodedImage& a, const DecodedImage& b, double largest) {
  DS_ASSERT(why_not_comparable(a, b).empty());
  const ImageSamples from(a), to(b);
  BytePicture picture{a.width, a.height, a.channels < 3 ? 1 : 3, {}};
  const auto channels = static_cast<std::size_t>(a.channels);
  const auto shown = static_cast<std::size_t>(picture.channels);
  picture.pixels.reserve(pixels_of(a) * shown);
  for (std::size_t p = 0; p < pixels_of(a); ++p)
    for (std::size_t c = 0; c < shown; ++c) {
      const double x = from[p * channels + c], y = to[p * channels + c];
      double value = 0;
      if (!are_equal(x, y)) {
        value = 255;
        if (std::isfinite(x) && std::isfinite(y) && largest > 0)
          value = std::clamp(std::round(255 * std::abs(x - y) / largest), 1.0, 255.0);
      }
      picture.pixels.push_back(static_cast<std::uint8_t>(value));
    }
  return picture;
}

}  // namespace ds
