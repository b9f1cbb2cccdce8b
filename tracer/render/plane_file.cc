// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/plane_file.h"

#include "tracer/base/error.h"
#include "tracer/kernels/layout.h"
#include "tracer/render/develop.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace ds {
namespace {

struct Row {
  PlaneEncoding encoding;
  std::string_view name, ending, format;
};
constexpr std::array k_rows = {
    Row{PlaneEncoding::png8, "png8", ".png", "png 8 bit, zlib 6, version 1"},
    Row{PlaneEncoding::png16, "png16", ".png", "png 16 bit, zlib 6, version 1"},
    Row{PlaneEncoding::half, "half", ".exr", "exr half, zip, version 2"},
    Row{PlaneEncoding::exr, "exr", ".exr", "exr float, zip, version 2"},
    Row{PlaneEncoding::rgba8, "rgba8", ".png", "png 8 bit rgba, tone map, zlib 6, version 1"}};

const Row& row_of(PlaneEncoding encoding) {
  return *std::find_if(k_rows.begin(), k_rows.end(),
                       [&](const Row& row) { return row.encoding == encoding; });
}

bool has(const PlaneType& type, unsigned trait) {
  return (type.traits & trait) != 0;
}

/// Of one pixel, in [0, most]; NaN gives 0.
void quantise(const PlaneType& type, const float* numbers, double most, std::uint16_t* out) {
  const auto width = static_cast<std::size_t>(type.width);
  const bool met = std::any_of(numbers, numbers + width, [](float v) { return v != 0; });
  for (std::size_t i = 0; i < width; ++i) {
    double value = double{numbers[i]};
    if (has(type, kernels::k_plane_png_signed)) value = met ? (value + 1) / 2 : 0.0;
    value = has(type, kernels::k_plane_png_milli) ? value * 1000 : value * most;
    const double whole = value > 0 ? std::min(std::floor(value + 0.5), most) : 0.0;
    out[i] = static_cast<std::uint16_t>(whole);
  }
}

void copy_word(const Plane& plane, float number, std::uint32_t most, std::uint16_t* out) {
  const auto word = std::bit_cast<std::uint32_t>(number);
  if (word > most)
    fail(ErrorKind::recipe,
         "the plane {} holds the id {}, and its file at most {}: give what has it a smaller id",
         plane.type->name, word, most);
  *out = static_cast<std::uint16_t>(word);
}

DeepPicture whole_numbers(const Plane& plane, std::uint32_t most) {
  DeepPicture picture{plane.width, plane.height, plane.type->width,
                      std::vector<std::uint16_t>(plane.values.size())};
  const auto width = static_cast<std::size_t>(plane.type->width);
  for (std::size_t i = 0; i < plane.values.size(); i += width) {
    if (has(*plane.type, kernels::k_plane_words))
      copy_word(plane, plane.values[i], most, &picture.pixels[i]);
    else
      quantise(*plane.type, &plane.values[i], most, &picture.pixels[i]);
  }
  return picture;
}

/// Y, or R, G and B, of which two numbers leave B at 0: OpenCV gives zeros, without a word, for a
/// file of other channels.
FloatPicture with_channels(const Plane& plane) {
  FloatPicture picture{plane.width, plane.height, {"Y"}, plane.values};
  if (plane.type->width == 1) return picture;
  picture.channels = {"R", "G", "B"};
  if (plane.type->width == 3) return picture;
  picture.values.clear();
  for (std::size_t i = 0; i < plane.values.size(); i += 2)
    for (const float value : {plane.values[i], plane.values[i + 1], 0.0f})
      picture.values.push_back(value);
  return picture;
}

}  // namespace

std::string_view name_of(PlaneEncoding encoding) {
  return row_of(encoding).name;
}
std::string_view ending_of(PlaneEncoding encoding) {
  return row_of(encoding).ending;
}
std::string_view format_of(PlaneEncoding encoding) {
  return row_of(encoding).format;
}

std::vector<PlaneEncoding> encodings_of(const PlaneType& type) {
  std::vector<PlaneEncoding> encodings;
  if (has(type, kernels::k_plane_exr)) encodings = {PlaneEncoding::exr, PlaneEncoding::half};
  if (has(type, kernels::k_plane_png_share)) encodings.push_back(PlaneEncoding::png8);
  if (has(type,
          kernels::k_plane_png_signed | kernels::k_plane_png_milli | kernels::k_plane_png_words))
    encodings.push_back(PlaneEncoding::png16);
  if (has(type, kernels::k_plane_png_signed | kernels::k_plane_png_words))
    encodings.push_back(PlaneEncoding::png8);
  if (has(type, kernels::k_plane_cut_out)) encodings.push_back(PlaneEncoding::rgba8);
  return encodings;
}

std::uint32_t largest_id(PlaneEncoding encoding) {
  return encoding == PlaneEncoding::png8 ? 255 : 65535;
}

std::vector<std::byte> encode_plane(const Plane& plane, PlaneEncoding encoding) {
  if (encoding == PlaneEncoding::exr || encoding == PlaneEncoding::half)
    return encode_exr(with_channels(plane), encoding == PlaneEncoding::half);
  if (encoding == PlaneEncoding::png16) return encode_png(whole_numbers(plane, 65535));
  const DeepPicture deep = whole_numbers(plane, 255);
  BytePicture picture{deep.width, deep.height, deep.channels, {}};
  for (const std::uint16_t value : deep.pixels)
    picture.pixels.push_back(static_cast<std::uint8_t>(value));
  return encode_png(picture);
}

BytePicture cut_out(const Plane& foreground, const Plane& alpha, const ToneMap& tone_map,
                    double scale) {
  DS_ASSERT(foreground.values.size() == 3 * alpha.values.size());
  Film film;
  film.width = foreground.width;
  film.height = foreground.height;
  film.rgb = foreground.values;
  for (std::size_t i = 0; i < alpha.values.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      film.rgb[3 * i + c] = alpha.values[i] > 0 ? film.rgb[3 * i + c] / alpha.values[i] : 0.0f;
  const BytePicture opaque = develop_at(film, tone_map, scale);
  BytePicture picture{foreground.width, foreground.height, 4, {}};
  picture.pixels.reserve(4 * alpha.values.size());
  for (std::size_t i = 0; i < alpha.values.size(); ++i) {
    const auto rgb = opaque.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i);
    picture.pixels.insert(picture.pixels.end(), rgb, rgb + 3);
    const double share = std::clamp(double{alpha.values[i]}, 0.0, 1.0);
    picture.pixels.push_back(static_cast<std::uint8_t>(std::floor(share * 255 + 0.5)));
  }
  return picture;
}

}  // namespace ds
