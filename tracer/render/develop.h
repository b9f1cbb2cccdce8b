// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "tracer/base/hash.h"
#include "tracer/render/render.h"

namespace ds {

/// 8-bit picture, row 0 at the top. `channels` is 1 or 3.
struct Picture {
  int width = 0, height = 0, channels = 3;
  std::vector<std::uint8_t> pixels;
};

/// Tone mapping, gamma, rounding to 8 bits. The same bits on every machine (no libm transcendental).
Picture develop(const Film& film, const ToneMap& tone_map);
/// 0 and 255 only.
Picture mask_picture(const Geometry& geometry);

/// Encoded files with fixed settings and no timestamp. PNG: 8 bit, zlib level 6. EXR: float, ZIP, one channel "Z".
std::vector<std::byte> encode_png(const Picture& picture);
std::vector<std::byte> encode_depth_exr(const Geometry& geometry);
/// A film as EXR: float32 R, G, B, ZIP; exact.
std::vector<std::byte> encode_film_exr(const Film& film);
/// Throws Error(asset) for bytes that are no such file. `name` stands in the message.
Film decode_film_exr(const std::vector<std::byte>& bytes, const std::string& name);

/// XXH3-128 over "WxHxC type\n" and the decoded pixels, so that another zlib or EXR library changes only the file's
/// hash. For PNG and EXR files of any content. Throws Error(asset) where the file cannot be decoded.
Hash128 pixel_hash(const std::filesystem::path& image_file);
Hash128 pixel_hash(const std::vector<std::byte>& encoded, const std::string& name);

}  // namespace ds
