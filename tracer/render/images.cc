// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/images.h"

#include "tracer/base/error.h"
#include "tracer/base/hash.h"
#include "tracer/base/log.h"
#include "tracer/render/image_files.h"
#include "tracer/render/strict_math.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace ds {
namespace {

/// Linear values of every stored 8- or 16-bit value.
std::vector<float> gamma_table(std::size_t size, float gamma) {
  std::vector<float> table(size);
  const double greatest = static_cast<double>(size - 1);
  for (std::size_t i = 0; i < size; ++i) {
    const double stored = static_cast<double>(i) / greatest;
    table[i] = static_cast<float>(strict_pow(stored, double{gamma}));
  }
  return table;
}

template <typename T>
T sample(const DecodedImage& decoded, std::size_t index) {
  T value;
  std::memcpy(&value, decoded.samples.data() + index * sizeof(T), sizeof(T));
  return value;
}

/// All samples as linear floats, alpha without gamma.
std::vector<float> linear_samples(const DecodedImage& decoded, float gamma) {
  const auto channels = static_cast<std::size_t>(decoded.channels);
  const std::size_t count =
      static_cast<std::size_t>(decoded.width) * static_cast<std::size_t>(decoded.height) * channels;
  const auto alpha =
      static_cast<std::size_t>(decoded.alpha_channel);  // -1 becomes a channel there is none of
  std::vector<float> values(count);
  if (decoded.type == SampleType::float32) {
    for (std::size_t i = 0; i < count; ++i)
      values[i] = sample<float>(decoded, i);
    return values;
  }
  const bool wide = decoded.type == SampleType::uint16;
  const std::size_t levels = wide ? 65536 : 256;
  const std::vector<float> color = gamma_table(levels, gamma), straight = gamma_table(levels, 1.0f);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t stored =
        wide ? std::size_t{sample<std::uint16_t>(decoded, i)} : sample<std::uint8_t>(decoded, i);
    values[i] = (i % channels == alpha ? straight : color)[stored];
  }
  return values;
}

/// Red, green and blue of a pixel; grey in all three.
Vec3 color_of(const float* pixel, int color_channels) {
  return color_channels >= 3 ? Vec3{pixel[0], pixel[1], pixel[2]}
                             : Vec3{pixel[0], pixel[0], pixel[0]};
}

Vec3 select(Vec3 color, float alpha, ImageChannel channel) {
  const auto grey = [](float value) { return Vec3{value, value, value}; };
  switch (channel) {
    case ImageChannel::rgb:
      return color;
    case ImageChannel::red:
      return grey(color.x);
    case ImageChannel::green:
      return grey(color.y);
    case ImageChannel::blue:
      return grey(color.z);
    case ImageChannel::alpha:
      return grey(alpha);
    case ImageChannel::mean:
      return grey((color.x + color.y + color.z) / 3.0f);
    case ImageChannel::colored_mean:
      return grey(0.212671f * color.x + 0.715160f * color.y + 0.072169f * color.z);
  }
  DS_ASSERT(false);
  return {};
}

void check_content(const Image& image) {
  if (image.content == Hash128{}) return;
  const Hash128 found = hash_file(image.file).xxh128;
  if (found != image.content)
    fail(ErrorKind::asset, "{}: changed since the scene was read: its hash was {} and is {}",
         image.file.string(), image.content.hex(), found.hex());
}

void check_finite(const Image& image, Vec3 color, std::size_t pixel, int width) {
  if (std::isfinite(color.x) && std::isfinite(color.y) && std::isfinite(color.z)) return;
  const auto columns = static_cast<std::size_t>(width);
  fail(ErrorKind::asset,
       "{}: pixel x = {}, y = {} (from the top left) must be finite, found {} {} {}",
       image.file.string(), pixel % columns, pixel / columns, color.x, color.y, color.z);
}

}  // namespace

void load_image(Image& image) {
  if (image.file.empty() || !image.rgb.empty()) return;
  check_content(image);
  const DecodedImage decoded = decode_image_file(image.file, Halves::widen);
  const bool has_alpha = decoded.alpha_channel >= 0;
  if (image.channel == ImageChannel::alpha && !has_alpha)
    fail(ErrorKind::asset, "{}: wanted the alpha channel, found none among {} channels",
         image.file.string(), decoded.channels);
  const std::vector<float> values = linear_samples(decoded, image.gamma);
  const auto channels = static_cast<std::size_t>(decoded.channels);
  const std::size_t pixels = values.size() / channels;
  image.rgb.resize(pixels * 3);
  std::size_t negative = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const float* pixel = values.data() + i * channels;
    const float alpha = has_alpha ? pixel[decoded.alpha_channel] : 1.0f;
    Vec3 color =
        select(color_of(pixel, decoded.channels - (has_alpha ? 1 : 0)), alpha, image.channel) *
        image.gain;
    check_finite(image, color, i, decoded.width);
    float* out = image.rgb.data() + i * 3;
    for (int c = 0; c < 3; ++c) {
      if (color[c] < 0) ++negative;
      out[c] = color[c] < 0 ? 0.0f : color[c];
    }
  }
  image.width = decoded.width;
  image.height = decoded.height;
  if (negative > 0)
    warn(fmt::format("{}: {} negative values of {} are taken as 0", image.file.string(), negative,
                     pixels * 3));
}

void load_images(Scene& scene) {
  for (Image& image : scene.images)
    load_image(image);
}

}  // namespace ds
