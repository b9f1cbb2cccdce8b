// SPDX-License-Identifier: Apache-2.0
// Every use of OpenImageIO: encoded pictures and films out, image files in. A module of its own:
// see image_codec.h.
#include "tracer/base/error.h"
#include "tracer/render/image_claims.h"
#include "tracer/render/image_codec.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <charconv>
#include <mutex>
#include <new>
#include <string_view>

namespace ds {
namespace {

constexpr const char* k_rejected_attribute = "dsbuild:rejectedSamples";
constexpr const char* k_error_attribute = "dsbuild:relativeError";

/// The pictures are small, and many processes share a machine: no threads of the library's own.
void set_up_library() {
  static std::once_flag once;
  std::call_once(once, [] {
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1);  // -1: none; 0 would be all cores
  });
}

/// The library's message on one line.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ')
    text.pop_back();
  return text;
}

std::vector<std::byte> encode(const char* format, const OIIO::ImageSpec& spec, const void* pixels) {
  set_up_library();
  OIIO::Filesystem::IOVecOutput memory;
  const std::string name = std::string("memory.") + format;
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name, &memory);
  const bool good = output && output->open(name, spec) &&
                    output->write_image(spec.format, pixels) && output->close();
  if (!good)
    fail(ErrorKind::io, "cannot encode a {} x {} {} picture: {}", spec.width, spec.height, format,
         one_line(output ? output->geterror() : OIIO::geterror()));
  const auto bytes = std::as_bytes(std::span(memory.buffer()));
  return {bytes.begin(), bytes.end()};
}

OIIO::ImageSpec exr_spec(int width, int height, std::vector<std::string> channels) {
  OIIO::ImageSpec spec(width, height, static_cast<int>(channels.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = std::move(channels);
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // left out, it would be the time of writing
  return spec;
}

std::optional<SampleType> sample_type(const OIIO::TypeDesc& format) {
  if (format == OIIO::TypeDesc::UINT8) return SampleType::uint8;
  if (format == OIIO::TypeDesc::UINT16) return SampleType::uint16;
  if (format == OIIO::TypeDesc::HALF) return SampleType::half;
  if (format == OIIO::TypeDesc::FLOAT) return SampleType::float32;
  return std::nullopt;
}

OIIO::TypeDesc library_type(SampleType type) {
  switch (type) {
    case SampleType::uint8:
      return OIIO::TypeDesc::UINT8;
    case SampleType::uint16:
      return OIIO::TypeDesc::UINT16;
    case SampleType::half:
      return OIIO::TypeDesc::HALF;
    case SampleType::float32:
      return OIIO::TypeDesc::FLOAT;
  }
  DS_ASSERT(false);
  return {};
}

OIIO::ImageSpec reading_options() {
  OIIO::ImageSpec options;
  options.attribute("oiio:UnassociatedAlpha", 1);
  return options;
}

/// Colours that the library multiplied by alpha though it was asked not to, or that the file has so.
bool is_premultiplied(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec) {
  const std::string_view format = input.format_name();
  const bool tells = format == "tiff" || format == "targa" || format == "webp";
  return tells && spec.alpha_channel >= 0 &&
         spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0;
}

/// Of Radiance files whose lines run up or down the library takes those from the left for those from
/// the right, and the other way round: "+X N +Y M" begins at the left bottom.
int orientation_of(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec) {
  const int orientation = spec.get_int_attribute("Orientation", 1);
  if (std::string_view(input.format_name()) != "hdr") return orientation;
  return orientation == 6 ? 8 : orientation == 8 ? 6 : orientation;
}

/// The library has such files made 8 bits, by their square root.
void refuse_log_luminance(const OIIO::ImageSpec& spec, const std::string& name) {
  constexpr int k_log_l = 32844, k_log_luv = 32845;
  const int meaning = spec.get_int_attribute("tiff:PhotometricInterpretation", 0);
  if (meaning == k_log_l || meaning == k_log_luv)
    fail(ErrorKind::asset,
         "{}: its colours are LogLuv, which is not supported: save it as float RGB, or as EXR",
         name);
}

/// The library takes memory for 64 rows at least: 128 MiB of four floats a pixel.
constexpr int k_most_width = 1 << 17;

/// Of a file of `file_bytes`.
DecodedImage decode(OIIO::ImageInput& input, const std::string& name, Halves halves,
                    std::size_t file_bytes) {
  const OIIO::ImageSpec spec = input.spec();
  refuse_log_luminance(spec, name);
  const std::uint64_t most = believable_pixels(file_bytes);
  const auto believable = [&](int width, int height) {
    const auto w = static_cast<std::uint64_t>(width), h = static_cast<std::uint64_t>(height);
    return width > 0 && height > 0 && w <= most && h <= most && w * h <= most;
  };
  const bool tiles_good =
      spec.tile_width == 0 || believable(spec.tile_width, std::max(spec.tile_height, 1));
  if (!believable(spec.width, spec.height) || !tiles_good || spec.depth > 1 || spec.deep)
    fail(ErrorKind::asset, "{}: wanted an image of 1 to {} pixels in {} bytes, found {} x {}{}",
         name, most, file_bytes, spec.width, spec.height, spec.deep ? ", deep" : "");
  if (spec.width > k_most_width)
    fail(ErrorKind::asset, "{}: wanted at most {} pixels a row, found {}", name, k_most_width,
         spec.width);
  const std::optional<SampleType> type = sample_type(spec.format);
  if (!type)
    fail(ErrorKind::asset, "{}: wanted samples of type uint8, uint16, half or float, found {}",
         name, spec.format.c_str());
  // Red, green, blue and alpha come first.
  constexpr int k_most_channels = 4;
  const int channels = std::min(spec.nchannels, k_most_channels);
  DecodedImage decoded;
  decoded.width = spec.width;
  decoded.height = spec.height;
  decoded.channels = channels;
  decoded.alpha_channel = spec.alpha_channel < channels ? spec.alpha_channel : -1;
  decoded.type = *type;
  decoded.channel_names = spec.channelnames;
  decoded.orientation = orientation_of(input, spec);
  decoded.premultiplied = is_premultiplied(input, spec);
  if (halves == Halves::widen && decoded.type == SampleType::half)
    decoded.type = SampleType::float32;
  const OIIO::TypeDesc format = library_type(decoded.type);
  // The library reads through a buffer of so many rows, 64 at least, however few the image has.
  constexpr std::uint64_t k_buffer_bytes = 16 << 20;
  OIIO::attribute("read_chunk", static_cast<int>(std::clamp<std::uint64_t>(
                                    k_buffer_bytes / spec.scanline_bytes(true), 1, 256)));
  decoded.samples.resize(static_cast<std::size_t>(spec.image_pixels()) *
                         static_cast<std::size_t>(channels) * format.size());
  if (!input.read_image(0, 0, 0, channels, format, decoded.samples.data()))
    fail(ErrorKind::asset, "{}: cannot read the pixels: {}", name, one_line(input.geterror()));
  return decoded;
}

/// A number that `film_exr` wrote beside the pixels.
template <typename Number>
Number film_number(const OIIO::ImageSpec& spec, const char* attribute, const std::string& name) {
  const std::string text = spec.get_string_attribute(attribute);
  Number number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || text.empty())
    fail(ErrorKind::asset,
         "{}: no film of ours: wanted the attribute {} with a number, found \"{}\"", name,
         attribute, text);
  return number;
}

/// Calls `read`; whatever the libraries below throw becomes an error with the file's name.
template <typename Read>
auto guarded(const std::string& name, const Read& read) {
  const char* what = "unknown error";
  std::string text;
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    what = "not enough memory";
  } catch (const std::exception& error) {
    text = one_line(error.what());
    what = text.c_str();
  } catch (...) {  // what is no std::exception, a library's own
  }
  fail(ErrorKind::asset, "{}: cannot be read as an image: {}", name, what);
}

/// An open reader on bytes in memory.
class MemoryInput {
 public:
  /// By a format's name alone: given a file name, the library looks for that file.
  MemoryInput(std::span<const std::byte> bytes, const std::string& format, const std::string& name)
      : reader_(bytes.data(), bytes.size()) {
    set_up_library();
    input_ = OIIO::ImageInput::create(format);
    OIIO::ImageSpec spec;
    if (!input_ || !input_->set_ioproxy(&reader_) || !input_->open(format, spec, reading_options()))
      fail(ErrorKind::asset, "{}: cannot be read as an image: {}", name,
           one_line(input_ ? input_->geterror() : OIIO::geterror()));
  }
  OIIO::ImageInput& input() { return *input_; }

 private:
  OIIO::Filesystem::IOMemReader reader_;
  std::unique_ptr<OIIO::ImageInput> input_;
};

DecodedImage decode_bytes(std::span<const std::byte> bytes, const std::string& format,
                          const std::string& name, Halves halves) {
  return guarded(name, [&] {
    MemoryInput memory(bytes, format, name);
    return decode(memory.input(), name, halves, bytes.size());
  });
}

std::vector<std::byte> png_of(int width, int height, int channels, const OIIO::TypeDesc& type,
                              std::span<const std::byte> pixels) {
  DS_ASSERT(channels == 1 || channels == 3 || channels == 4);
  OIIO::ImageSpec spec(width, height, channels, type);
  DS_ASSERT(pixels.size() == spec.image_bytes());
  if (channels == 4) spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("png:compressionLevel", 6);
  spec.attribute("png:filter",
                 0x80);  // libpng's PNG_FILTER_PAETH on every row: its choice by trial may change
  return encode("png", spec, pixels.data());
}

std::vector<std::byte> png(const BytePicture& picture) {
  return png_of(picture.width, picture.height, picture.channels, OIIO::TypeDesc::UINT8,
                std::as_bytes(std::span(picture.pixels)));
}

std::vector<std::byte> deep_png(const DeepPicture& picture) {
  return png_of(picture.width, picture.height, picture.channels, OIIO::TypeDesc::UINT16,
                std::as_bytes(std::span(picture.pixels)));
}

std::vector<std::byte> jpeg(const BytePicture& picture, int quality) {
  DS_ASSERT(picture.channels == 1 || picture.channels == 3);
  OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, OIIO::TypeDesc::UINT8);
  DS_ASSERT(picture.pixels.size() == spec.image_bytes());
  spec.attribute("compression", fmt::format("jpeg:{}", quality));
  spec.attribute("jpeg:subsampling", "4:2:0");
  return encode("jpg", spec, picture.pixels.data());
}

std::vector<std::byte> float_exr(const FloatPicture& picture, bool as_half) {
  OIIO::ImageSpec spec = exr_spec(picture.width, picture.height, picture.channels);
  DS_ASSERT(picture.values.size() * sizeof(float) == spec.image_bytes());
  if (!as_half) return encode("exr", spec, picture.values.data());
  spec.set_format(OIIO::TypeDesc::HALF);
  std::vector<std::uint16_t> halves(picture.values.size());
  const bool good =
      OIIO::convert_pixel_values(OIIO::TypeDesc::FLOAT, picture.values.data(), OIIO::TypeDesc::HALF,
                                 halves.data(), static_cast<int>(halves.size()));
  DS_ASSERT(good);
  return encode("exr", spec, halves.data());
}

std::vector<std::byte> film_exr(const Film& film) {
  OIIO::ImageSpec spec = exr_spec(film.width, film.height, {"R", "G", "B"});
  DS_ASSERT(film.rgb.size() * sizeof(float) == spec.image_bytes());
  spec.attribute(k_rejected_attribute, std::to_string(film.rejected_samples));
  if (film.relative_error)  // the shortest text that reads back exactly
    spec.attribute(k_error_attribute, fmt::format("{}", *film.relative_error));
  return encode("exr", spec, film.rgb.data());
}

Film film_of_exr(const std::vector<std::byte>& bytes, const std::string& format,
                 const std::string& name) {
  return guarded(name, [&] {
    MemoryInput memory(bytes, format, name);
    const DecodedImage decoded = decode(memory.input(), name, Halves::keep, bytes.size());
    if (decoded.channels != 3 || decoded.type != SampleType::float32)
      fail(ErrorKind::asset, "{}: no film of ours: wanted 3 channels of float, found {} of {}",
           name, decoded.channels, sample_type_name(decoded.type));
    Film film{decoded.width, decoded.height,
              std::vector<float>(decoded.samples.size() / sizeof(float)),
              film_number<std::uint64_t>(memory.input().spec(), k_rejected_attribute, name),
              std::nullopt};
    if (memory.input().spec().find_attribute(k_error_attribute) != nullptr)
      film.relative_error = film_number<double>(memory.input().spec(), k_error_attribute, name);
    std::copy(decoded.samples.begin(), decoded.samples.end(),
              std::as_writable_bytes(std::span(film.rgb)).begin());
    return film;
  });
}

}  // namespace

extern "C" const ImageCodec* dsbuild_image_codec() {
  static constexpr ImageCodec codec{decode_bytes, png,      deep_png,   jpeg,
                                    float_exr,    film_exr, film_of_exr};
  return &codec;
}

}  // namespace ds
