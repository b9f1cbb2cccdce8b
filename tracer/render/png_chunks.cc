// SPDX-License-Identifier: Apache-2.0
// PNG (ISO/IEC 15948): 8 bytes of signature, then chunks of a length, a type of four letters, as many
// bytes, and a checksum. A capital first letter marks a chunk that no reader may leave out.
#include "tracer/render/png_chunks.h"

#include "tracer/base/error.h"

#include <algorithm>
#include <string_view>

namespace ds {
namespace {

constexpr std::size_t k_signature = 8, k_frame = 12;

std::size_t big32(std::span<const std::byte> bytes) {
  std::size_t number = 0;
  for (std::size_t i = 0; i < 4; ++i)
    number = number << 8U | std::to_integer<std::size_t>(bytes[i]);
  return number;
}

}  // namespace

std::vector<std::byte> pixel_chunks(std::span<const std::byte> png, const std::string& name) {
  std::vector<std::byte> kept(
      png.begin(), png.begin() + static_cast<std::ptrdiff_t>(std::min(png.size(), k_signature)));
  for (std::size_t at = k_signature;;) {
    const std::size_t left = png.size() - std::min(at, png.size());
    const std::size_t size = left < k_frame ? 0 : big32(png.subspan(at));
    if (left < k_frame || size > left - k_frame)
      fail(ErrorKind::asset, "{}: cannot be read as an image: the PNG file is cut off", name);
    const auto chunk = png.subspan(at, size + k_frame);
    const std::string_view type(reinterpret_cast<const char*>(chunk.data()) + 4, 4);
    if ((type[0] >= 'A' && type[0] <= 'Z') || type == "tRNS")
      kept.insert(kept.end(), chunk.begin(), chunk.end());
    if (type == "IEND") return kept;
    at += chunk.size();
  }
}

}  // namespace ds
