// SPDX-License-Identifier: Apache-2.0
#include "manifests/gallery/previews.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace ds {
namespace {

DecodedImage floats(int width, int height, int channels, const std::vector<float>& values) {
  DecodedImage image;
  image.width = width;
  image.height = height;
  image.channels = channels;
  image.type = SampleType::float32;
  image.samples.resize(values.size() * sizeof(float));
  std::memcpy(image.samples.data(), values.data(), image.samples.size());
  return image;
}

DecodedImage bytes(int width, int height, int channels, const std::vector<std::uint8_t>& values) {
  DecodedImage image;
  image.width = width;
  image.height = height;
  image.channels = channels;
  for (const std::uint8_t value : values)
    image.samples.push_back(std::byte{value});
  return image;
}

TEST(Previews, PicturesStayAndTransparencyIsOverGrey) {
  EXPECT_EQ(preview_of(bytes(1, 1, 3, {1, 2, 255}), "image").pixels,
            (std::vector<std::uint8_t>{1, 2, 255}));
  const BytePicture clear = preview_of(bytes(2, 1, 4, {255, 0, 0, 255, 255, 0, 0, 0}), "image");
  EXPECT_EQ(clear.channels, 3);
  EXPECT_EQ(clear.pixels, (std::vector<std::uint8_t>{255, 0, 0, 128, 128, 128}));
}

TEST(Previews, NearIsBrightAndNothingBlack) {
  const float nothing = std::numeric_limits<float>::infinity();
  const BytePicture depth = preview_of(floats(4, 1, 1, {1, 2, 0, nothing}), "depth");
  EXPECT_EQ(depth.channels, 1);
  EXPECT_EQ(depth.pixels, (std::vector<std::uint8_t>{255, 38, 0, 0}));  // 0.15 * 255
  EXPECT_EQ(preview_of(floats(2, 1, 1, {3, 3}), "distance").pixels,
            (std::vector<std::uint8_t>{255, 255}));
}

TEST(Previews, DirectionsAreCentred) {
  EXPECT_EQ(preview_of(floats(2, 1, 3, {-1, 0, 1, 0, 0, 0}), "shading_normal").pixels,
            (std::vector<std::uint8_t>{0, 128, 255, 0, 0, 0}));
  EXPECT_EQ(preview_of(bytes(1, 1, 3, {0, 128, 255}), "geometry_normal").pixels,
            (std::vector<std::uint8_t>{0, 128, 255}));
}

TEST(Previews, IdsHaveColoursOfTheirOwn) {
  const BytePicture ids = preview_of(bytes(4, 1, 1, {0, 1, 2, 1}), "object_id");
  const auto color = [&](std::size_t pixel) {
    return std::vector<std::uint8_t>(
        ids.pixels.begin() + static_cast<std::ptrdiff_t>(3 * pixel),
        ids.pixels.begin() + static_cast<std::ptrdiff_t>(3 * pixel + 3));
  };
  EXPECT_EQ(color(0), (std::vector<std::uint8_t>{0, 0, 0}));
  EXPECT_EQ(color(1), color(3));
  EXPECT_NE(color(1), color(2));
  EXPECT_NE(color(1), color(0));
}

TEST(Previews, PlanesNobodyKnowsShowTheirRange) {
  EXPECT_EQ(preview_of(floats(3, 1, 1, {-2, 0, 2}), "of a newer dsbuild").pixels,
            (std::vector<std::uint8_t>{0, 0, 0, 128, 128, 128, 255, 255, 255}));
}

TEST(ScaledDown, AveragesAreasAndKeepsTheMean) {
  const BytePicture two{2, 2, 1, {0, 100, 200, 100}};
  EXPECT_EQ(scaled_down(two, 1).pixels, std::vector<std::uint8_t>{100});
  EXPECT_EQ(scaled_down(two, 2).pixels, two.pixels);
  // 3 to 2: each pixel takes one whole and half of the middle one.
  const BytePicture three = scaled_down({3, 1, 1, {0, 90, 240}}, 2);
  EXPECT_EQ(three.width, 2);
  EXPECT_EQ(three.pixels, (std::vector<std::uint8_t>{30, 190}));
  const BytePicture tall = scaled_down({10, 1000, 3, std::vector<std::uint8_t>(30000, 77)}, 128);
  EXPECT_EQ((std::array{tall.width, tall.height}), (std::array{1, 128}));
  EXPECT_EQ(tall.pixels, std::vector<std::uint8_t>(std::size_t{3} * 128, 77));
}

TEST(BrightnessOf, IsMeanAndDeviationOfLuma) {
  const Brightness half = brightness_of({2, 1, 1, {0, 255}});
  EXPECT_DOUBLE_EQ(half.mean, 0.5);
  EXPECT_DOUBLE_EQ(half.deviation, 0.5);
  EXPECT_NEAR(brightness_of({1, 1, 3, {0, 255, 0}}).mean, 0.7152, 1e-12);
}

}  // namespace
}  // namespace ds
