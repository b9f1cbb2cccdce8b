// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/develop.h"
#include "tracer/render/image_files.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace ds {

/// What OpenImageIO does for image_files.h and develop.h, which say what each function does. It
/// brings 250 libraries, and loading them takes 0.3 s, ten times what else a command does at its
/// start: so it is a module that is loaded at the first image read or written.
struct ImageCodec {
  /// `format` is what check_image_claims found.
  DecodedImage (*decode_bytes)(std::span<const std::byte> bytes, const std::string& format,
                               const std::string& name, Halves halves);
  std::vector<std::byte> (*encode_png)(const BytePicture& picture);
  std::vector<std::byte> (*encode_deep_png)(const DeepPicture& picture);
  std::vector<std::byte> (*encode_jpeg)(const BytePicture& picture, int quality);
  std::vector<std::byte> (*encode_exr)(const FloatPicture& picture, bool as_half);
  std::vector<std::byte> (*encode_film_exr)(const Film& film);
  Film (*decode_film_exr)(const std::vector<std::byte>& bytes, const std::string& format,
                          const std::string& name);
};

/// What the module dsbuild_images exports.
extern "C" const ImageCodec* dsbuild_image_codec();

}  // namespace ds
