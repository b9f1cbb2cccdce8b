// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/images.h"

#include "tracer/base/error.h"
#include "tracer/base/file_names.h"
#include "tracer/base/hash.h"
#include "tracer/base/log.h"
#include "tracer/base/luminance.h"
#include "tracer/render/image_files.h"
#include "tracer/render/image_meaning.h"
#include "tracer/render/strict_math.h"
#include "tracer/scene/own_materials.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace ds {
namespace {

/// sRGB's, IEC 61966-2-1.
double linear_of_srgb(double stored) {
  return stored <= 0.04045 ? stored / 12.92 : strict_pow((stored + 0.055) / 1.055, 2.4);
}

/// How stored whole numbers are meant.
struct Transfer {
  float gamma = 1;
  bool srgb = false;
};

/// Linear values of every stored 8- or 16-bit value.
std::vector<float> linear_table(std::size_t size, const Transfer& transfer) {
  std::vector<float> table(size);
  const double greatest = static_cast<double>(size - 1);
  for (std::size_t i = 0; i < size; ++i) {
    const double stored = static_cast<double>(i) / greatest;
    table[i] = static_cast<float>(transfer.srgb ? linear_of_srgb(stored)
                                                : strict_pow(stored, double{transfer.gamma}));
  }
  return table;
}

template <typename T>
T sample(const DecodedImage& decoded, std::size_t index) {
  T value;
  std::memcpy(&value, decoded.samples.data() + index * sizeof(T), sizeof(T));
  return value;
}

/// Stored samples as linear floats, alpha as it stands.
class LinearSamples {
 public:
  LinearSamples(const DecodedImage& decoded, const Transfer& transfer) : decoded_(decoded) {
    if (decoded.type == SampleType::float32) return;
    const std::size_t levels = decoded.type == SampleType::uint16 ? 65536 : 256;
    color_ = linear_table(levels, transfer);
    straight_ = linear_table(levels, {});
  }

  float color(std::size_t pixel, int channel) const { return at(pixel, channel, color_); }
  float alpha(std::size_t pixel) const { return at(pixel, decoded_.alpha_channel, straight_); }

 private:
  float at(std::size_t pixel, int channel, const std::vector<float>& table) const {
    const std::size_t index =
        pixel * static_cast<std::size_t>(decoded_.channels) + static_cast<std::size_t>(channel);
    if (decoded_.type == SampleType::float32) return sample<float>(decoded_, index);
    return decoded_.type == SampleType::uint16 ? table[sample<std::uint16_t>(decoded_, index)]
                                               : table[sample<std::uint8_t>(decoded_, index)];
  }

  const DecodedImage& decoded_;
  std::vector<float> color_, straight_;
};

Vec3 times(const ColorMatrix& m, Vec3 c) {
  const Vec3d v = to_double(c);
  return to_float(Vec3d{m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
                        m[6] * v.x + m[7] * v.y + m[8] * v.z});
}

/// The colour of a stored pixel; grey in all three. Where the file multiplied it by alpha, a
/// texture takes what is left of that; a light is what shines.
Vec3 color_of(const LinearSamples& samples, std::size_t pixel, const ImageMeaning& meaning,
              bool has_alpha, ImageUse use) {
  if (meaning.color_channels == 0) return {};
  const bool grey = meaning.color_channels == 1;
  const float first = samples.color(pixel, 0);
  Vec3 color{first, grey ? first : samples.color(pixel, 1), grey ? first : samples.color(pixel, 2)};
  if (meaning.premultiplied && has_alpha && use == ImageUse::texture) {
    const float alpha = samples.alpha(pixel);
    if (alpha > 0 && alpha != 1) color = Vec3{color.x / alpha, color.y / alpha, color.z / alpha};
  }
  return meaning.matrix ? times(*meaning.matrix, color) : color;
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
      return grey(static_cast<float>(k_luxcore_weights[0]) * color.x +
                  static_cast<float>(k_luxcore_weights[1]) * color.y +
                  static_cast<float>(k_luxcore_weights[2]) * color.z);
  }
  DS_ASSERT(false);
  return {};
}

std::string name_of(const Image& image) {
  return image.embedded < 0 ? image.file.string()
                            : fmt::format("{}, image {}", image.file.string(), image.embedded);
}

void check_content(const Image& image, const std::string& bytes) {
  if (image.content == Hash128{}) return;
  const Hash128 found = hash_text(bytes);
  if (found != image.content)
    fail(ErrorKind::asset, "{}: changed since the scene was read: its hash was {} and is {}",
         name_of(image), image.content.hex(), found.hex());
}

/// What the image is asked for and does not have.
void check_use(const Image& image, const DecodedImage& decoded, const ImageMeaning& meaning) {
  const std::string name = name_of(image);
  if (decoded.type != SampleType::float32 && is_named_hdr(image.file))
    fail(ErrorKind::asset,
         "{}: its name says that it holds floats, which have no gamma; found whole numbers of {} "
         "bits (an ending of theirs, as .png, gives them their gamma)",
         name, decoded.type == SampleType::uint16 ? 16 : 8);
  if (image.channel == ImageChannel::alpha) {
    if (decoded.alpha_channel < 0)
      fail(ErrorKind::asset, "{}: wanted the alpha channel, found none among {} channels", name,
           decoded.channels);
  } else if (meaning.color_channels == 0) {
    fail(ErrorKind::asset, "{}: wanted a colour, found alpha alone", name);
  }
  if (meaning.cube && image.use == ImageUse::light)
    fail(ErrorKind::asset,
         "{}: a light wants its picture by longitude and latitude, found the faces of a cube "
         "(exrenvmap converts it)",
         name);
}

void check_finite(const Image& image, Vec3 color, std::size_t pixel, int width) {
  if (std::isfinite(color.x) && std::isfinite(color.y) && std::isfinite(color.z)) return;
  const auto columns = static_cast<std::size_t>(width);
  fail(ErrorKind::asset,
       "{}: pixel x = {}, y = {} (from the top left) must be finite, found {} {} {}",
       name_of(image), pixel % columns, pixel / columns, color.x, color.y, color.z);
}

}  // namespace

void load_image(Image& image) {
  if (image.file.empty() || !image.rgb.empty()) return;
  const std::string name = name_of(image);
  std::string bytes =
      image.embedded < 0 ? read_image_file(image.file) : embedded_image(image.file, image.embedded);
  check_content(image, bytes);
  const DecodedImage decoded = decode_image_bytes(bytes_of(bytes), name, Halves::widen);
  const ImageMeaning meaning = image_meaning(bytes_of(bytes), decoded, name);
  std::string().swap(bytes);
  check_use(image, decoded, meaning);
  const bool has_alpha = decoded.alpha_channel >= 0;
  const LinearSamples samples(decoded, {image.gamma, image.srgb});
  const std::size_t pixels =
      static_cast<std::size_t>(meaning.width) * static_cast<std::size_t>(meaning.height);
  std::vector<float> rgb(pixels * 3);
  std::size_t negative = 0, black = 0, not_stored = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto columns = static_cast<std::size_t>(meaning.width);
    const auto stored =
        meaning.stored(static_cast<int>(i % columns), static_cast<int>(i / columns));
    Vec3 color;
    if (stored)
      color = select(color_of(samples, *stored, meaning, has_alpha, image.use),
                     has_alpha ? samples.alpha(*stored) : 1.0f, image.channel) *
              image.gain;
    else
      ++not_stored;
    check_finite(image, color, i, meaning.width);
    for (int c = 0; c < 3; ++c) {
      if (color[c] < 0) ++negative;
      rgb[i * 3 + static_cast<std::size_t>(c)] = color[c] < 0 ? 0.0f : color[c];
    }
    black += color.x <= 0 && color.y <= 0 && color.z <= 0 ? 1U : 0U;
  }
  image.rgb = std::move(rgb);
  image.width = meaning.width;
  image.height = meaning.height;
  if (negative > 0)
    warn(fmt::format("{}: {} negative values of {} are taken as 0", name, negative, pixels * 3));
  if (!meaning.unused.empty()) warn(fmt::format("{}: {} are not used", name, meaning.unused));
  if (not_stored == pixels)
    warn(
        fmt::format("{}: its data window lies wholly outside of its display window, which is the "
                    "picture: it is black throughout",
                    name));
  else if (black == pixels && image.use == ImageUse::light)
    warn(fmt::format("{}: all {} pixels are black, so it gives no light", name, pixels));
}

void load_images(Scene& scene) {
  for (Image& image : scene.images)
    load_image(image);
}

}  // namespace ds
