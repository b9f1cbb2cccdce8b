// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/image_files.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/render/develop.h"
#include "tracer/render/image_claims.h"
#include "tracer/render/image_codec.h"
#include "tracer/render/png_chunks.h"

#include <dlfcn.h>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Beside the program, where it was built; in lib/dsbuild beside its bin, where it is installed.
fs::path module_file() {
  constexpr const char* k_name = "dsbuild_images.so";
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path beside = folder / k_name;
  return fs::exists(beside, error) ? beside : folder.parent_path() / "lib" / "dsbuild" / k_name;
}

const ImageCodec& load_codec() {
  const fs::path file = module_file();
  void* const module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const symbol = module == nullptr ? nullptr : ::dlsym(module, "dsbuild_image_codec");
  if (symbol == nullptr)
    fail(ErrorKind::io, "cannot load what reads and writes images: {}", ::dlerror());
  return *reinterpret_cast<decltype(&dsbuild_image_codec)>(symbol)();
}

/// Throws Error(io) where the module cannot be loaded.
const ImageCodec& codec() {
  static const ImageCodec& loaded = load_codec();
  return loaded;
}

}  // namespace

std::string read_image_file(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    fail(ErrorKind::asset, "{}: wanted an image file, found none", file.string());
  return read_text_file(file);
}

DecodedImage decode_image_bytes(std::span<const std::byte> bytes, const std::string& name,
                                Halves halves) {
  const std::string format = check_image_claims(bytes, name);
  if (format == "png") return codec().decode_bytes(pixel_chunks(bytes, name), format, name, halves);
  return codec().decode_bytes(bytes, format, name, halves);
}

std::vector<std::byte> encode_png(const BytePicture& picture) {
  return codec().encode_png(picture);
}

std::vector<std::byte> encode_png(const DeepPicture& picture) {
  return codec().encode_deep_png(picture);
}

std::vector<std::byte> encode_jpeg(const BytePicture& picture, int quality) {
  DS_ASSERT(quality >= 1 && quality <= 100);
  return codec().encode_jpeg(picture, quality);
}

std::vector<std::byte> encode_exr(const FloatPicture& picture, bool as_half) {
  return codec().encode_exr(picture, as_half);
}

std::vector<std::byte> encode_film_exr(const Film& film) {
  return codec().encode_film_exr(film);
}

Film decode_film_exr(const std::vector<std::byte>& bytes, const std::string& name) {
  const std::string format = check_image_claims(bytes, name);
  return codec().decode_film_exr(bytes, format, name);
}

Hash128 pixel_hash(const std::vector<std::byte>& encoded, const std::string& name) {
  const DecodedImage decoded = decode_image_bytes(encoded, name, Halves::keep);
  const std::string header = fmt::format("{}x{}x{} {}\n", decoded.width, decoded.height,
                                         decoded.channels, sample_type_name(decoded.type));
  std::vector<std::byte> hashed(header.size() + decoded.samples.size());
  const auto text = bytes_of(header);
  std::copy(text.begin(), text.end(), hashed.begin());
  std::copy(decoded.samples.begin(), decoded.samples.end(),
            hashed.begin() + static_cast<std::ptrdiff_t>(header.size()));
  return hash_bytes(hashed);
}

Hash128 pixel_hash(const fs::path& image_file) {
  const std::string text = read_text_file(image_file);
  const auto bytes = bytes_of(text);
  return pixel_hash(std::vector<std::byte>(bytes.begin(), bytes.end()), image_file.string());
}

}  // namespace ds
