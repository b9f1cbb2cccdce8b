// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/camera_effects.h"

#include "tracer/base/canonical.h"
#include "tracer/base/degrees.h"
#include "tracer/base/error.h"
#include "tracer/base/hash.h"
#include "tracer/render/image_files.h"
#include "tracer/render/strict_math.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace ds {
namespace {

/// Version of what the effects do to a picture.
constexpr int k_effects_version = 1;
/// Variance read out of a pixel without light, of that at white.
constexpr double k_read_share = 0.01;

std::size_t at(const Film& film, int x, int y) {
  return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width) +
              static_cast<std::size_t>(x));
}

/// Calls `visit` with each pixel's column, row and values.
template <typename Visit>
void for_each_pixel(Film& film, const Visit& visit) {
  for (int y = 0; y < film.height; ++y)
    for (int x = 0; x < film.width; ++x)
      visit(x, y, film.rgb.data() + at(film, x, y));
}

void scale(float* rgb, double factor) {
  for (std::size_t c = 0; c < 3; ++c)
    rgb[c] = static_cast<float>(double{rgb[c]} * factor);
}

void vignette(Film& film, double share) {
  const double half_width = film.width / 2.0, half_height = film.height / 2.0;
  const double corner2 = half_width * half_width + half_height * half_height;
  for_each_pixel(film, [&](int x, int y, float* rgb) {
    const double dx = x + 0.5 - half_width, dy = y + 0.5 - half_height;
    scale(rgb, 1 - share * (dx * dx + dy * dy) / corner2);
  });
}

/// Up to three deviations, of sum 1.
std::vector<double> gaussian(double deviation) {
  const int radius = std::max(1, static_cast<int>(std::ceil(3 * deviation)));
  std::vector<double> weights;
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(strict_exp(-i * i / (2 * deviation * deviation)));
    sum += weights.back();
  }
  for (double& weight : weights)
    weight /= sum;
  return weights;
}

/// Along one axis; the picture's edge goes on as it is.
Film blurred(const Film& film, const std::vector<double>& weights, bool down) {
  Film to = film;
  const int radius = static_cast<int>(weights.size() / 2);
  for_each_pixel(to, [&](int x, int y, float* rgb) {
    std::array<double, 3> sum{};
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const int i = static_cast<int>(k) - radius;
      const int from_x = down ? x : std::clamp(x + i, 0, film.width - 1);
      const int from_y = down ? std::clamp(y + i, 0, film.height - 1) : y;
      const float* from = film.rgb.data() + at(film, from_x, from_y);
      for (std::size_t c = 0; c < 3; ++c)
        sum[c] += weights[k] * double{from[c]};
    }
    for (std::size_t c = 0; c < 3; ++c)
      rgb[c] = static_cast<float>(sum[c]);
  });
  return to;
}

/// Two numbers of the normal distribution (Box and Muller) of one hash.
std::array<double, 2> normal_pair(std::uint64_t seed, int x, int y, int pair) {
  const std::array<std::uint64_t, 3> words{
      seed, static_cast<std::uint64_t>(y) << 32U | static_cast<std::uint64_t>(x),
      static_cast<std::uint64_t>(pair)};
  std::array<std::byte, sizeof(words)> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::byte>(words[i / 8] >> (8 * (i % 8)));
  const Hash128 hash = hash_bytes(bytes);
  const double u = (static_cast<double>(hash.high >> 11U) + 0.5) * 0x1p-53;
  const double turn_deg = static_cast<double>(hash.low >> 11U) * 0x1p-53 * 360;
  const double radius = std::sqrt(-2 * strict_log(u));
  return {radius * cos_deg(turn_deg), radius * sin_deg(turn_deg)};
}

void add_noise(Film& film, double tone_scale, double noise, std::uint64_t seed) {
  // A black film has a scale without meaning, and stays black but for what is read out.
  const double unit = tone_scale > 0 && std::isfinite(tone_scale) ? tone_scale : 1;
  for_each_pixel(film, [&](int x, int y, float* rgb) {
    const std::array<double, 2> first = normal_pair(seed, x, y, 0),
                                second = normal_pair(seed, x, y, 1);
    const std::array<double, 3> normal{first[0], first[1], second[0]};
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = std::max(0.0, double{rgb[c]} * unit);
      const double noisy = value + noise * std::sqrt(value + k_read_share) * normal[c];
      rgb[c] = static_cast<float>(std::max(0.0, noisy) / unit);
    }
  });
}

BytePicture through_jpeg(const BytePicture& picture, int quality) {
  const std::vector<std::byte> bytes = encode_jpeg(picture, quality);
  const DecodedImage decoded = decode_image_bytes(bytes, "a picture's JPEG", Halves::keep);
  DS_ASSERT(decoded.type == SampleType::uint8 && decoded.channels == picture.channels &&
            decoded.samples.size() == picture.pixels.size());
  BytePicture to = picture;
  std::transform(decoded.samples.begin(), decoded.samples.end(), to.pixels.begin(),
                 [](std::byte sample) { return std::to_integer<std::uint8_t>(sample); });
  return to;
}

}  // namespace

Film with_effects(const Film& film, double tone_scale, const CameraEffects& effects) {
  Film to = film;
  if (effects.exposure_ev != 0) {
    const double factor = strict_pow(2, effects.exposure_ev);
    for_each_pixel(to, [&](int, int, float* rgb) { scale(rgb, factor); });
  }
  if (effects.vignetting != 0) vignette(to, effects.vignetting);
  if (effects.blur_px != 0) {
    const std::vector<double> weights = gaussian(effects.blur_px);
    to = blurred(blurred(to, weights, false), weights, true);
  }
  if (effects.noise != 0) add_noise(to, tone_scale, effects.noise, effects.seed);
  return to;
}

DevelopedPicture develop(const Film& film, const ToneMap& tone_map, const CameraEffects& effects) {
  const double tone_scale = tone_map_scale(film, tone_map);
  if (effects.none())
    return {develop_at(film, tone_map, tone_scale), tone_scale,
            clipped_pixels_at(film, tone_map, tone_scale)};
  const Film seen = with_effects(film, tone_scale, effects);
  BytePicture picture = develop_at(seen, tone_map, tone_scale);
  if (effects.jpeg_quality != 0) picture = through_jpeg(picture, effects.jpeg_quality);
  return {std::move(picture), tone_scale, clipped_pixels_at(seen, tone_map, tone_scale)};
}

std::string canonical_effects(const CameraEffects& effects) {
  CanonicalText text;
  if (effects.none()) return "";
  text.add("camera.effects_version", k_effects_version);
  if (effects.exposure_ev != 0) text.add("camera.exposure_ev", effects.exposure_ev);
  if (effects.vignetting != 0) text.add("camera.vignetting", effects.vignetting);
  if (effects.blur_px != 0) text.add("camera.blur_px", effects.blur_px);
  if (effects.noise != 0) {
    text.add("camera.noise", effects.noise);
    text.add("camera.noise_seed", effects.seed);
  }
  if (effects.jpeg_quality != 0) text.add("camera.jpeg_quality", effects.jpeg_quality);
  return text.text();
}

}  // namespace ds
