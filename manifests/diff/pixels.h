// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/develop.h"
#include "tracer/render/image_files.h"

#include <cstdint>
#include <optional>
#include <string>

namespace ds {

/// How far two pictures of one size are apart, over all channels of all pixels. Values are those
/// stored: 8- and 16-bit numbers over their greatest, so from 0 to 1; floats as they are.
struct PixelDifference {
  std::uint64_t of = 0;      ///< pixels of each
  std::uint64_t pixels = 0;  ///< of them, those that differ in any channel
  /// Of those, the ones where a channel is not finite in one picture and another value in the other;
  /// they are in no figure below.
  std::uint64_t not_finite = 0;
  double largest = 0;  ///< greatest |a - b|
  int x = 0, y = 0;    ///< where, from the top left
  double rms = 0;      ///< square root of the mean of (a - b)^2 over all finite pairs

  bool operator==(const PixelDifference&) const = default;
};

/// Why two pictures cannot be compared pixel by pixel: "64x64, 3 channels of uint8 and 32x32, ...";
/// "" where they can.
std::string why_not_comparable(const DecodedImage& a, const DecodedImage& b);

/// Of comparable pictures. Two infinities of one sign are equal, as two NaNs are.
PixelDifference pixel_difference(const DecodedImage& a, const DecodedImage& b);

/// |a - b| of comparable pictures as 8-bit pixels, where `largest` is 255 and what differs at all is 1
/// at least; a pair that is not finite is 255. Grey for one channel and two, else the first three.
BytePicture difference_picture(const DecodedImage& a, const DecodedImage& b, double largest);

}  // namespace ds
