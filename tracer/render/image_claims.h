// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace ds {

/// The most pixels an image may have.
inline constexpr std::uint64_t k_most_image_pixels = std::uint64_t{1} << 28;

/// How many pixels a file of so many bytes can be believed to hold, so that a header alone takes no
/// memory. 4096 a byte is over what any encoder makes of a picture of one colour but lossless WebP
/// and EXR's DWAB; 2^21 are granted whatever the size. A file of 1 KB then costs 2^22 pixels of at
/// most 28 bytes, 112 MiB.
inline std::uint64_t believable_pixels(std::size_t file_bytes) {
  constexpr std::uint64_t k_always = std::uint64_t{1} << 21, k_a_byte = 4096;
  const std::uint64_t bytes = std::min<std::uint64_t>(file_bytes, k_most_image_pixels);
  return std::clamp(bytes * k_a_byte, k_always, k_most_image_pixels);
}

/// The file format by the first bytes, as OpenImageIO names it ("openexr", "hdr", "png", "jpeg",
/// "tiff", "bmp", "targa", "pnm", "webp", "gif"), and what the header of a format promises whose
/// reader takes memory before anyone can ask it: checked here. Throws Error(asset) with `name` for
/// another format, for a picture no file of this size can hold, and for a JPEG file that is cut off
/// (its reader would make the rest grey).
std::string check_image_claims(std::span<const std::byte> bytes, const std::string& name);

}  // namespace ds
