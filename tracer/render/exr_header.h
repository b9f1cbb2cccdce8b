// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ds {

/// The header of an OpenEXR file ("OpenEXR File Layout", version 2), as far as it says how large
/// the picture is and what its numbers mean:
///
///   file      = MAGIC version header {header} 0?  tables chunks   the 0 behind the headers of
///   parts version   = 2 | tiled << 9 | long names << 10 | not an image << 11 | parts << 12 header
///   = {attribute} 0 attribute = NAME 0 TYPE 0 SIZE value[SIZE] tables    = {OFFSET} 64 bits each,
///   a chunk's place in the file, by part chunk     = PART? (Y | TX TY LX LY) SIZE data[SIZE]
///
/// All little-endian. Boxes are x0 y0 x1 y1, the last row and column included.
struct ExrBox {
  std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  std::int64_t width() const { return std::int64_t{x1} - x0 + 1; }
  std::int64_t height() const { return std::int64_t{y1} - y0 + 1; }
};

enum class ExrEnvironment { latlong = 0, cube = 1 };

/// Of the first part.
struct ExrHeader {
  std::vector<std::string> channels;  ///< in the file's order
  ExrBox data;                        ///< which pixels are stored
  ExrBox display;                     ///< the picture
  /// CIE x and y of red, green, blue and white; absent: those of Rec.709.
  std::optional<std::array<double, 8>> chromaticities;
  std::optional<ExrEnvironment> environment;
  std::size_t parts = 1;
};

bool is_exr(std::span<const std::byte> bytes);

/// Reads the headers and checks that the file holds what they promise: that every table and chunk
/// of the first part's full resolution is there, where it should be and of a size that can be true,
/// and that no buffer a reader needs is out of proportion to the file. Takes memory only in
/// proportion to the file. Throws Error(asset) with `name`; also for what is not read: deep pixels,
/// subsampled channels.
ExrHeader read_exr_header(std::span<const std::byte> bytes, const std::string& name);

}  // namespace ds
