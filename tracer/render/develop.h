// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/hash.h"
#include "tracer/render/render.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace ds {

/// 8-bit picture, row 0 at the top. `channels` is 1, 3 or 4: the last is straight alpha.
struct BytePicture {
  int width = 0, height = 0, channels = 3;
  std::vector<std::uint8_t> pixels;
};

/// 16-bit picture, likewise.
struct DeepPicture {
  int width = 0, height = 0, channels = 1;
  std::vector<std::uint16_t> pixels;
};
/// Picture of floats with named channels, likewise interleaved.
struct FloatPicture {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<float> values;
};

/// The factor that the tone map found for this film, for the manifest. With LuxCore's luminance
/// Y = 0.212671 R + 0.715160 G + 0.072169 B it is:
/// - linear: `scale`;
/// - autolinear: 1.25 / mean(Y) * (118 / 255)^gamma, the mean over all pixels, of which those with
///   Y <= 0 or not finite count as 0; 1 where the mean is 0;
/// - reinhard02: 0.1 / exp(mean(log(max(Y, 1e-6)))).
/// As in LuxCore's film/imagepipeline/plugins/tonemaps, but summed in double. The film holds at
/// least one pixel.
double tone_map_scale(const Film& film, const ToneMap& tone_map);

/// round(255 * clamp(factor * rgb, 0, 1)^(1 / gamma)), halves up. `factor` is tone_map_scale; for
/// reinhard02 it is s * postscale * (1 + y / burn^2) / (1 + y), where s is tone_map_scale and
/// y = Y * s / prescale (burn <= 0: 1e5 stands for 1 / burn^2). In double and exact, where LuxCore
/// looks gamma up in a table of 4096 steps. The same bits on every machine: no libm transcendental.
/// NaN gives 0. gamma > 0.
BytePicture develop(const Film& film, const ToneMap& tone_map);
/// The same with a scale of another film's, as of this one before it was changed.
BytePicture develop_at(const Film& film, const ToneMap& tone_map, double scale);
/// Pixels of which `develop` takes light away in every channel: the tone map gives each over 1.05.
/// At 1, as of a plain white sky, nothing is lost.
std::uint64_t clipped_pixels(const Film& film, const ToneMap& tone_map);
std::uint64_t clipped_pixels_at(const Film& film, const ToneMap& tone_map, double scale);
/// What `develop` makes of linear radiance before it rounds, in [0, 1], within 1e-4 and in a tenth
/// of the time: for error estimates. The same bits on every machine.
class ToneCurve {
 public:
  /// `scale`: as tone_map_scale finds it.
  ToneCurve(const ToneMap& tone_map, double scale);
  std::array<double, 3> at(const std::array<float, 3>& rgb) const;

 private:
  double power(double linear) const;

  ToneMap tone_map_;
  double scale_;
  std::vector<double> table_;  ///< v^(1 / gamma) at the steps of `power`
};

/// Encoded files with fixed settings; no timestamp, host or version stands in them. PNG: 8 or 16
/// bit, zlib level 6, Paeth filter. EXR: float or half, ZIP. The same library versions give the same
/// bytes.
std::vector<std::byte> encode_png(const BytePicture& picture);
std::vector<std::byte> encode_png(const DeepPicture& picture);
/// JPEG of 4:2:0 colours, no metadata; `quality` is libjpeg's, 1 to 100. For looking at, never for data.
std::vector<std::byte> encode_jpeg(const BytePicture& picture, int quality);
std::vector<std::byte> encode_exr(const FloatPicture& picture, bool as_half);
/// A film as EXR: float32 R, G, B, ZIP; exact, with the count of rejected samples as an attribute.
std::vector<std::byte> encode_film_exr(const Film& film);
/// Throws Error(asset) for bytes that `encode_film_exr` did not write. `name` stands in the
/// message.
Film decode_film_exr(const std::vector<std::byte>& bytes, const std::string& name);

/// XXH3-128 over "WxHxC type\n" and the decoded pixels, so that another zlib or EXR library changes
/// only the file's hash. `type` is uint8, uint16, half or float, as stored. For PNG and EXR files
/// of any content, 1 to 4 channels. Throws Error(asset) where the file cannot be decoded, Error(io)
/// where it cannot be read.
Hash128 pixel_hash(const std::filesystem::path& image_file);
Hash128 pixel_hash(const std::vector<std::byte>& encoded, const std::string& name);

}  // namespace ds
