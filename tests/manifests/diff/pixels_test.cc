// SPDX-License-Identifier: Apache-2.0
#include "manifests/diff/pixels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace ds {
namespace {

constexpr float k_infinity = std::numeric_limits<float>::infinity();

template <typename T>
DecodedImage image_of(SampleType type, int width, int channels, const std::vector<T>& values) {
  DecodedImage image;
  image.width = width;
  image.height = static_cast<int>(values.size()) / width / channels;
  image.channels = channels;
  image.type = type;
  image.samples.resize(values.size() * sizeof(T));
  std::memcpy(image.samples.data(), values.data(), image.samples.size());
  return image;
}

DecodedImage bytes(int width, int channels, const std::vector<std::uint8_t>& values) {
  return image_of(SampleType::uint8, width, channels, values);
}

DecodedImage floats(int width, const std::vector<float>& values) {
  return image_of(SampleType::float32, width, 1, values);
}

TEST(PixelDifference, OfEqualPicturesIsNothing) {
  const DecodedImage a = bytes(2, 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  EXPECT_EQ(pixel_difference(a, a), (PixelDifference{.of = 4}));
}

TEST(PixelDifference, TellsTheLargestWithItsPlaceAndTheRms) {
  // Of 2 x 2 pixels of three channels one differs by 51 and one by 102: 0.2 and 0.4.
  const DecodedImage a = bytes(2, 3, {0, 0, 0, 9, 9, 9, 100, 0, 0, 0, 0, 0});
  const DecodedImage b = bytes(2, 3, {0, 51, 0, 9, 9, 9, 202, 0, 0, 0, 0, 0});
  for (const auto& [x, y] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    const PixelDifference found = pixel_difference(*x, *y);
    EXPECT_EQ(found.pixels, 2u);
    EXPECT_DOUBLE_EQ(found.largest, 0.4);
    EXPECT_EQ(found.x, 0);
    EXPECT_EQ(found.y, 1);
    EXPECT_NEAR(found.rms, std::sqrt((0.04 + 0.16) / 12), 1e-15);
  }
}

TEST(PixelDifference, CountsAPixelOnceHoweverManyChannelsDiffer) {
  EXPECT_EQ(pixel_difference(bytes(1, 3, {1, 2, 3}), bytes(1, 3, {3, 2, 1})).pixels, 1u);
}

TEST(PixelDifference, SixteenBitsAreOverTheirGreatest) {
  const DecodedImage a = image_of<std::uint16_t>(SampleType::uint16, 1, 1, {0});
  const DecodedImage b = image_of<std::uint16_t>(SampleType::uint16, 1, 1, {13107});  // 65535 / 5
  EXPECT_DOUBLE_EQ(pixel_difference(a, b).largest, 0.2);
}

TEST(PixelDifference, WhatIsNotFiniteInOneAloneIsCountedAndInNoFigure) {
  const float nan = std::nanf("");
  const DecodedImage a = floats(5, {k_infinity, nan, k_infinity, nan, 1});
  const DecodedImage b = floats(5, {k_infinity, nan, -k_infinity, 2, 1.5f});
  const PixelDifference found = pixel_difference(a, b);
  EXPECT_EQ(found, (PixelDifference{
                       .of = 5, .pixels = 3, .not_finite = 2, .largest = 0.5, .x = 4, .rms = 0.5}));
  const BytePicture picture = difference_picture(a, b, found.largest);
  EXPECT_EQ(picture.pixels, (std::vector<std::uint8_t>{0, 0, 255, 255, 255}));
}

TEST(PixelDifference, OtherShapesAreNotCompared) {
  EXPECT_EQ(why_not_comparable(bytes(1, 3, {1, 2, 3}), bytes(1, 3, {7, 8, 9})), "");
  EXPECT_EQ(why_not_comparable(bytes(3, 1, {1, 2, 3}), floats(1, {1, 2})),
            "3x1, 1 channel of uint8 and 1x2, 1 channel of float");
}

TEST(DifferencePicture, ShowsTheLargestWhiteAndTheLeastToo) {
  const DecodedImage a = floats(4, {0, 0, 0, 1000});
  const DecodedImage b = floats(4, {0, 0.5f, 500, 0});
  const BytePicture picture = difference_picture(a, b, 1000);
  EXPECT_EQ(picture.channels, 1);
  EXPECT_EQ(picture.pixels, (std::vector<std::uint8_t>{0, 1, 128, 255}));
}

TEST(DifferencePicture, HasNoAlpha) {
  const BytePicture picture =
      difference_picture(bytes(1, 4, {0, 10, 20, 0}), bytes(1, 4, {51, 10, 20, 255}), 0.2);
  EXPECT_EQ(picture.channels, 3);
  EXPECT_EQ(picture.pixels, (std::vector<std::uint8_t>{255, 0, 0}));
}

}  // namespace
}  // namespace ds
