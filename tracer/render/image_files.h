// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace ds {

enum class SampleType { uint8, uint16, half, float32 };
/// "uint8", "uint16", "half", "float".
inline constexpr const char* sample_type_name(SampleType type) {
  constexpr std::array k_names{"uint8", "uint16", "half", "float"};
  return k_names[static_cast<std::size_t>(type)];
}

/// The pixels of a file as they are stored: no gamma, nothing done about alpha. Row 0 is the first
/// stored, left to right, channels interleaved in the order R, G, B, A where they have these names;
/// machine byte order.
struct DecodedImage {
  int width = 0, height = 0;
  int channels = 0;            ///< at most 4
  int alpha_channel = -1;      ///< -1: none
  bool premultiplied = false;  ///< of others than EXR: colours come multiplied by alpha
  SampleType type = SampleType::uint8;
  std::vector<std::byte> samples;
  std::vector<std::string> channel_names;  ///< of all the file's; the first `channels` are here
  int orientation = 1;  ///< Exif's: 1: row 0 is the top and column 0 the left, to 8
};

/// Whether 16-bit floats come as such or as the equal 32-bit ones.
enum class Halves { keep, widen };

/// The bytes of an image file. Throws Error(asset) where it is none, or a folder; Error(io) where
/// it cannot be read.
std::string read_image_file(const std::filesystem::path& file);

/// Any of the formats of image_claims.h, told apart by their first bytes. `name` stands in
/// messages. Throws Error(asset) with it for whatever goes wrong, what libraries throw included.
DecodedImage decode_image_bytes(std::span<const std::byte> bytes, const std::string& name,
                                Halves halves);

}  // namespace ds
