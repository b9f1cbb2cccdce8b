// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/develop.h"
#include "tracer/render/image_files.h"

#include <string>
#include <string_view>

namespace ds {

/// A file of the dataset as 8 bit samples to look at. Of a picture, a mask or a plane of shares the
/// samples as they are, over grey where it is transparent. Depths and distances: near is bright, as far
/// as there is anything, which else is black. Directions: [-1, 1] to [0, 255]. Ids: a colour each.
/// Light: the square root, so that the brightest hundredth is white.
/// `kind` is "image" or a plane's name; one that is not known shows its range.
BytePicture preview_of(const DecodedImage& image, std::string_view kind);

/// Averages of areas, so that neither side is longer than `longest`; smaller ones stay.
BytePicture scaled_down(const BytePicture& picture, int longest);

/// Of 8 bit samples, in [0, 1]: mean and standard deviation of luma (Rec.709's weights on the samples as
/// they are).
struct Brightness {
  double mean = 0, deviation = 0;
};
Brightness brightness_of(const BytePicture& picture);

}  // namespace ds
