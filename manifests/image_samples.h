// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"
#include "tracer/render/image_files.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace ds {

/// Stored samples of an image as numbers: 8- and 16-bit ones over their greatest, floats as they are
/// (halves widened). Views the image.
class ImageSamples {
 public:
  explicit ImageSamples(const DecodedImage& image) : image_(image) {
    DS_ASSERT(image.type != SampleType::half);
  }
  double operator[](std::size_t i) const {
    switch (image_.type) {
      case SampleType::uint8:
        return std::to_integer<int>(image_.samples[i]) / 255.0;
      case SampleType::uint16:
        return at<std::uint16_t>(i) / 65535.0;
      default:
        return double{at<float>(i)};
    }
  }

 private:
  template <typename T>
  T at(std::size_t i) const {
    T value;
    std::memcpy(&value, image_.samples.data() + i * sizeof(T), sizeof(T));
    return value;
  }

  const DecodedImage& image_;
};

}  // namespace ds
