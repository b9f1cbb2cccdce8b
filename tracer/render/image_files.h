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

/// The pixels of a file as they are stored: no gamma, colours not multiplied by alpha. Row 0 is the
/// top, left to right, channels interleaved in the order R, G, B, A where they have these names;
/// machine byte order.
struct DecodedImage {
  int width = 0, height = 0, channels = 0;
  int alpha_channel = -1;  ///< -1: none
  SampleType type = SampleType::uint8;
  std::vector<std::byte> samples;
};

/// Whether 16-bit floats come as such or as the equal 32-bit ones.
enum class Halves { keep, widen };

/// Throws Error(asset) with the file's name, see `load_image`.
DecodedImage decode_image_file(const std::filesystem::path& file, Halves halves);
/// PNG or EXR, told apart by their first bytes. `name` stands in messages.
DecodedImage decode_image_bytes(std::span<const std::byte> bytes, const std::string& name,
                                Halves halves);

}  // namespace ds
