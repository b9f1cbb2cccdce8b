// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/image_files.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ds {

/// CIE x and y of red, green, blue and white.
using Chromaticities = std::array<double, 8>;
/// Row by row; applied to linear red, green and blue.
using ColorMatrix = std::array<double, 9>;

/// What takes linear colours of the given primaries and white to Rec.709's: by way of XYZ, with the
/// whites made one by Bradford's adaptation (Lindbloom, "Chromatic Adaptation"), so that (1, 1, 1)
/// stays. Nothing where they are Rec.709's to 5e-4 and where they span no colours.
std::optional<ColorMatrix> to_rec709(const Chromaticities& from);

/// How the stored pixels of a file make a picture.
struct ImageMeaning {
  int width = 0, height = 0;  ///< of the picture
  int color_channels = 0;     ///< 3: red, green, blue; 1: grey; 0: alpha alone
  bool premultiplied = false;
  bool cube = false;  ///< an environment in six faces, not by longitude and latitude
  std::optional<ColorMatrix> matrix;
  std::string unused;  ///< what the file holds and nothing reads, in words; empty: nothing

  // From the picture to the stored: turned by Exif's orientation, then moved by the window.
  int orientation = 1;
  int stored_width = 0, stored_height = 0;
  int offset_x = 0, offset_y = 0;  ///< of the first stored pixel in the unturned picture

  /// Which stored pixel is at (x, y) from the picture's top left; nothing for the background.
  std::optional<std::size_t> stored(int x, int y) const;
};

/// EXR: the display window is the picture, the data window what is stored of it; channels by their
/// names (R, G, B or Y, with or without A; one of any other name is grey; what shares one layer's
/// name loses that); colours are multiplied by alpha, as those of some TIFF, TGA and WebP files;
/// chromaticities. Radiance HDR: PRIMARIES. Others: what the reader found. Exif's orientation for all but EXR. Throws Error(asset) with
/// `name` for what makes no picture: two of three colours, luminance and chroma, alpha and depth,
/// primaries that span no colours.
ImageMeaning image_meaning(std::span<const std::byte> bytes, const DecodedImage& decoded,
                           const std::string& name);

}  // namespace ds
