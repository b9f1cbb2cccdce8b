// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/image_claims.h"

#include "tracer/base/error.h"
#include "tracer/render/exr_header.h"
#include "tracer/render/tiff_directory.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace ds {
namespace {

struct Size {
  std::uint64_t width = 0, height = 0;
};

/// Bytes as unsigned numbers; 0 behind the end.
class View {
 public:
  explicit View(std::span<const std::byte> bytes)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}

  std::size_t size() const { return text_.size(); }
  bool has(std::string_view wanted, std::size_t at = 0) const {
    return text_.substr(std::min(at, text_.size())).starts_with(wanted);
  }
  std::uint32_t byte(std::size_t at) const {
    return at < text_.size() ? static_cast<unsigned char>(text_[at]) : 0;
  }
  std::uint32_t big16(std::size_t at) const { return byte(at) << 8U | byte(at + 1); }
  std::uint32_t little16(std::size_t at) const { return byte(at) | byte(at + 1) << 8U; }
  std::uint32_t little24(std::size_t at) const {
    return byte(at) | byte(at + 1) << 8U | byte(at + 2) << 16U;
  }
  std::uint32_t big32(std::size_t at) const { return big16(at) << 16U | big16(at + 2); }
  std::size_t find(std::string_view wanted, std::size_t from = 0) const {
    return text_.find(wanted, from);
  }
  std::string_view text(std::size_t begin, std::size_t end) const {
    return text_.substr(begin, end - begin);
  }
  std::size_t rfind(std::string_view wanted) const { return text_.rfind(wanted); }

 private:
  std::string_view text_;
};

/// TGA has no magic number: what every file of it has in its first 18 bytes.
bool may_be_targa(const View& view) {
  const std::uint32_t kind = view.byte(2), depth = view.byte(16);
  const bool kind_known =
      (kind >= 1 && kind <= 3 && view.byte(1) <= 1) || (kind >= 9 && kind <= 11);
  return view.size() >= 18 && kind_known &&
         (depth == 8 || depth == 15 || depth == 16 || depth == 24 || depth == 32);
}

std::string format_of(std::span<const std::byte> bytes) {
  const View view(bytes);
  if (is_exr(bytes)) return "openexr";
  if (view.has("#?")) return "hdr";
  if (view.has("\x89PNG\r\n\x1a\n")) return "png";
  if (view.has("\xff\xd8\xff")) return "jpeg";
  if (view.has({"II*\0", 4}) || view.has({"MM\0*", 4}) || view.has({"II+\0", 4}) ||
      view.has({"MM\0+", 4}))
    return "tiff";
  if (view.has("BM")) return "bmp";
  if (view.has("RIFF") && view.has("WEBP", 8)) return "webp";
  if (view.has("GIF8")) return "gif";
  const bool pnm = view.byte(0) == 'P' && ((view.byte(1) >= '1' && view.byte(1) <= '6') ||
                                           view.byte(1) == 'f' || view.byte(1) == 'F');
  if (pnm) return "pnm";
  return may_be_targa(view) ? "targa" : "";
}

Size png_size(const View& view) {
  return {view.big32(16), view.big32(20)};
}

/// The frame header of a JPEG file, and where its first scan starts.
struct JpegHead {
  Size size;
  std::size_t scan = 0;
};
std::optional<JpegHead> jpeg_head(const View& view) {
  JpegHead head;
  for (std::size_t at = 2; at + 4 <= view.size();) {
    if (view.byte(at) != 0xff) return std::nullopt;
    const std::uint32_t marker = view.byte(at + 1);
    if (marker == 0xff) {  // fill bytes may stand before a marker
      ++at;
      continue;
    }
    const bool frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) head.size = {view.big16(at + 7), view.big16(at + 5)};
    if (marker == 0xda) {
      head.scan = at;
      return head;
    }
    at += 2 + std::max(view.big16(at + 2), 2U);
  }
  return std::nullopt;
}

/// The canvas: of the extended, the lossy or the lossless form.
Size webp_size(const View& view) {
  if (view.has("VP8X", 12)) return {view.little24(24) + 1, view.little24(27) + 1};
  if (view.has("VP8L", 12)) {
    const std::uint32_t bits = view.little24(21) | view.byte(24) << 24U;
    return {(bits & 0x3fffU) + 1, (bits >> 14U & 0x3fffU) + 1};
  }
  return {view.little24(26) & 0x3fffU, view.little24(28) & 0x3fffU};
}

/// "-Y 512 +X 1024": how many lines, and how many pixels each has; 0 where it is no such line.
Size radiance_size(std::string_view line) {
  std::array<std::uint64_t, 2> numbers{};
  for (std::uint64_t& number : numbers) {
    line.remove_prefix(std::min(line.find_first_of("XY"), line.size()));
    line.remove_prefix(std::min(line.find_first_of("0123456789"), line.size()));
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
    if (error != std::errc()) return {};
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  }
  return {numbers[1], numbers[0]};
}

/// Radiance's run-length encoding of before 1991 (Ward, "Real Pixels", Graphics Gems II): a pixel 1 1
/// 1 n repeats the one before. OpenImageIO takes it for pixels as they stand: too few, or as many where
/// each run is of one.
bool has_old_runs(const View& view) {
  const std::size_t head = view.find("\n\n");
  if (head == std::string_view::npos) return false;
  const std::size_t end = view.find("\n", head + 2);
  if (end == std::string_view::npos) return false;
  const Size size = radiance_size(view.text(head + 2, end));
  const std::size_t pixels = end + 1;
  const bool new_runs =
      view.byte(pixels) == 2 && view.byte(pixels + 1) == 2 && view.big16(pixels + 2) == size.width;
  if (new_runs || size.width == 0) return false;
  bool any = false;
  std::uint64_t meant =
      0;  // pixels, where these are runs; of marks in a row each counts for 256 before
  unsigned shift = 0;
  for (std::size_t at = pixels; at + 4 <= view.size(); at += 4) {
    const bool run = view.byte(at) == 1 && view.byte(at + 1) == 1 && view.byte(at + 2) == 1;
    any = any || run;
    meant += run ? std::uint64_t{view.byte(at + 3)} << std::min(shift, 32U) : 1;
    shift = run ? shift + 8 : 0;
  }
  const bool too_few = (view.size() - pixels) / 4 / size.width < size.height;
  return any && (too_few || meant == size.width * size.height);
}

}  // namespace

std::string check_image_claims(std::span<const std::byte> bytes, const std::string& name) {
  std::string format = format_of(bytes);
  const View view(bytes);
  const auto check = [&](Size size) {
    const std::uint64_t most = believable_pixels(bytes.size());
    if (size.width > most || size.height > most || size.width * size.height > most)
      fail(ErrorKind::asset,
           "{}: cannot be read as an image: its header promises {} x {} pixels, of a file of {} "
           "bytes "
           "at most {} are believed",
           name, size.width, size.height, bytes.size(), most);
  };
  if (format.empty())
    fail(ErrorKind::asset,
         "{}: cannot be read as an image: wanted EXR, HDR (Radiance), PNG, JPEG, TIFF, BMP, TGA, "
         "PNM, PFM, WebP or GIF, found none of them",
         name);
  if (format == "openexr") read_exr_header(bytes, name);
  if (format == "hdr" && view.find("FORMAT=32-bit_rle_xyze") < view.find("\n\n"))
    fail(ErrorKind::asset, "{}: wanted colours of red, green and blue, found XYZ", name);
  if (format == "hdr" && has_old_runs(view))
    fail(
        ErrorKind::asset,
        "{}: its pixels are in Radiance's old run-length encoding, which is not supported: ra_xyze "
        "-r, of Radiance, writes it anew",
        name);
  if (format == "tiff") check_tiff(bytes, name);
  if (format == "png") check(png_size(view));
  if (format == "webp") check(webp_size(view));
  if (format == "gif") check({view.little16(6), view.little16(8)});  // its canvas
  if (format == "jpeg") {
    const std::optional<JpegHead> head = jpeg_head(view);
    // Thumbnails stand before the scan and have an end of their own.
    const std::size_t end = view.rfind("\xff\xd9");
    if (!head || end == std::string_view::npos || end < head->scan)
      fail(ErrorKind::asset, "{}: cannot be read as an image: the JPEG file is cut off", name);
    check(head->size);
  }
  return format;
}

}  // namespace ds
