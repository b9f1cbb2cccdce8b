// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/exr_header.h"

#include "tracer/base/error.h"
#include "tracer/render/image_claims.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

namespace ds {
namespace {

constexpr std::uint32_t k_magic = 20000630;
constexpr std::uint32_t k_tiled = 0x200, k_not_an_image = 0x800, k_multi_part = 0x1000;
/// More than any writer makes; so that a header cannot be made slow.
constexpr std::size_t k_most_channels = 1024, k_most_parts = 256, k_longest_name = 255;
/// The library adds and multiplies coordinates as ints.
constexpr std::int64_t k_farthest = std::int64_t{1} << 30;

/// Rows of a chunk, by the number of the compression: none, rle, zips, zip, piz, pxr24, b44, b44a,
/// dwaa, dwab.
constexpr std::array<int, 10> k_chunk_rows{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
constexpr std::size_t k_none = 0, k_rle = 1;

struct Tiles {
  std::uint32_t width = 0, height = 0;
  unsigned mode = 0;  ///< 0: one level, 1: mipmap, 2: ripmap
  bool round_up = false;
};

/// One part's header and what follows from it.
struct Part {
  ExrHeader header;
  std::size_t compression = k_none;
  std::optional<Tiles> tiles;
  std::optional<std::int32_t> chunk_count;
  std::string type;
  std::uint64_t pixel_bytes = 0;
  bool subsampled = false;
  bool has_channels = false, has_data = false, has_display = false, has_compression = false;
};

class Parser {
 public:
  Parser(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  ExrHeader parse() {
    at_ = 4;
    const auto version = number<std::uint32_t>();
    if ((version & 0xffU) != 2) refuse("version must be 2, got {}", version & 0xffU);
    multi_part_ = (version & k_multi_part) != 0;
    do {
      if (parts_.size() == k_most_parts) refuse("more than {} parts", k_most_parts);
      parts_.push_back(read_part((version & k_tiled) != 0 && !multi_part_));
    } while (multi_part_ && peek() != 0);
    if (multi_part_) ++at_;
    const Part& first = parts_.front();
    if ((version & k_not_an_image) != 0 && !multi_part_) refuse("deep pixels are not read");
    if (first.type.starts_with("deep")) refuse("deep pixels are not read");
    if (first.subsampled)
      refuse(
          "channels of fewer samples than pixels are not read, found {} (luminance and chroma "
          "want converting to R, G, B)",
          fmt::join(first.header.channels, ", "));
    check_sizes(first);
    check_chunks(first);
    ExrHeader header = first.header;
    header.parts = parts_.size();
    return header;
  }

 private:
  template <typename... Args>
  [[noreturn]] void refuse(fmt::format_string<Args...> format, Args&&... args) const {
    fail(ErrorKind::asset, "{}: cannot be read as an image: {}", name_,
         fmt::format(format, std::forward<Args>(args)...));
  }

  std::size_t left() const { return bytes_.size() - at_; }
  void need(std::size_t count) const {
    if (count > left()) refuse("cut off in its header");
  }
  std::uint8_t peek() const {
    need(1);
    return static_cast<std::uint8_t>(bytes_[at_]);
  }
  template <typename T>
  T number_at(std::size_t place) const {
    static_assert(std::endian::native == std::endian::little);
    T value;
    std::memcpy(&value, bytes_.data() + place, sizeof(T));
    return value;
  }
  template <typename T>
  T number() {
    need(sizeof(T));
    const T value = number_at<T>(at_);
    at_ += sizeof(T);
    return value;
  }
  std::string text() {
    const char* const begin = reinterpret_cast<const char*>(bytes_.data()) + at_;
    const std::size_t most = std::min(left(), k_longest_name + 1);
    const auto* const end = static_cast<const char*>(std::memchr(begin, 0, most));
    if (end == nullptr) refuse("a name in its header has no end");
    at_ += static_cast<std::size_t>(end - begin) + 1;
    return {begin, end};
  }

  ExrBox box() {
    ExrBox b;
    b.x0 = number<std::int32_t>();
    b.y0 = number<std::int32_t>();
    b.x1 = number<std::int32_t>();
    b.y1 = number<std::int32_t>();
    for (const std::int32_t x : {b.x0, b.y0, b.x1, b.y1})
      if (std::abs(std::int64_t{x}) > k_farthest) refuse("a window reaches to {}", x);
    if (b.width() < 1 || b.height() < 1) refuse("a window of {} x {}", b.width(), b.height());
    return b;
  }

  /// A name from the file, fit for a message.
  static std::string shown(std::string text) {
    for (char& c : text)
      if (c < ' ' || c > '~') c = '?';
    return text;
  }

  void read_channels(Part& part) {
    while (peek() != 0) {
      if (part.header.channels.size() == k_most_channels)
        refuse("more than {} channels", k_most_channels);
      part.header.channels.push_back(shown(text()));
      const auto type = number<std::int32_t>();
      if (type < 0 || type > 2) refuse("unknown type {} of a channel", type);
      part.pixel_bytes += type == 1 ? 2 : 4;
      number<std::uint32_t>();  // pLinear and reserved
      const auto x = number<std::int32_t>(), y = number<std::int32_t>();
      part.subsampled = part.subsampled || x != 1 || y != 1;
    }
    ++at_;
    part.has_channels = true;
  }

  void read_tiles(Part& part) {
    Tiles tiles;
    tiles.width = number<std::uint32_t>();
    tiles.height = number<std::uint32_t>();
    const auto mode = number<std::uint8_t>();
    tiles.mode = mode & 0xfU;
    tiles.round_up = mode >> 4U != 0;
    if (tiles.width == 0 || tiles.height == 0 || tiles.mode > 2)
      refuse("tiles of {} x {}, mode {}", tiles.width, tiles.height, tiles.mode);
    part.tiles = tiles;
  }

  void read_chromaticities(Part& part) {
    std::array<double, 8> values{};
    for (double& value : values)
      value = double{number<float>()};
    part.header.chromaticities = values;
  }

  /// The library takes as much memory as a preview's two sizes say.
  void check_preview() {
    const std::uint64_t width = number<std::uint32_t>(), height = number<std::uint32_t>();
    if (width > left() || height > left() || width * height > left() / 4)
      refuse("a preview of {} x {}", width, height);
  }

  void read_attribute(Part& part, const std::string& attribute, const std::string& type) {
    const auto is = [&](std::string_view wanted_name, std::string_view wanted_type) {
      return attribute == wanted_name && type == wanted_type;
    };
    if (is("channels", "chlist")) {
      read_channels(part);
    } else if (is("compression", "compression")) {
      part.compression = number<std::uint8_t>();
      part.has_compression = true;
      if (part.compression >= k_chunk_rows.size())
        refuse("unknown compression {}", part.compression);
    } else if (is("dataWindow", "box2i")) {
      part.header.data = box();
      part.has_data = true;
    } else if (is("displayWindow", "box2i")) {
      part.header.display = box();
      part.has_display = true;
    } else if (is("tiles", "tiledesc")) {
      read_tiles(part);
    } else if (is("chromaticities", "chromaticities")) {
      read_chromaticities(part);
    } else if (is("envmap", "envmap")) {
      part.header.environment =
          number<std::uint8_t>() == 0 ? ExrEnvironment::latlong : ExrEnvironment::cube;
    } else if (is("chunkCount", "int")) {
      part.chunk_count = number<std::int32_t>();
    } else if (type == "preview") {
      check_preview();
    }
  }

  Part read_part(bool flagged_tiled) {
    Part part;
    while (peek() != 0) {
      const std::string attribute = text(), type = text();
      const auto size = number<std::int32_t>();
      if (size < 0 || static_cast<std::size_t>(size) > left())
        refuse("cut off in its header: attribute {} promises {} bytes, {} follow", shown(attribute),
               size, left());
      const std::size_t end = at_ + static_cast<std::size_t>(size);
      if (attribute == "type" && type == "string")
        part.type.assign(reinterpret_cast<const char*>(bytes_.data()) + at_,
                         static_cast<std::size_t>(size));
      read_attribute(part, attribute, type);
      if (at_ > end)
        refuse("attribute {} of type {} has {} bytes", shown(attribute), shown(type), size);
      at_ = end;
    }
    ++at_;
    if (!part.has_channels || part.header.channels.empty()) refuse("no channels");
    if (!part.has_data || !part.has_display || !part.has_compression)
      refuse("its header lacks dataWindow, displayWindow or compression");
    const bool tiled = flagged_tiled || part.type == "tiledimage" || part.type == "deeptile";
    if (tiled && !part.tiles) refuse("its header lacks the size of the tiles");
    if (!tiled) part.tiles.reset();
    return part;
  }

  /// What a reader of the part keeps in memory, against what the file can be believed to hold.
  void check_sizes(const Part& part) const {
    const ExrBox &data = part.header.data, &display = part.header.display;
    const std::uint64_t most = believable_pixels(bytes_.size());
    for (const ExrBox& window : {data, display}) {
      const auto width = static_cast<std::uint64_t>(window.width());
      const auto height = static_cast<std::uint64_t>(window.height());
      if (width > most || height > most || width * height > most)
        refuse("its header promises {} x {} pixels, of a file of {} bytes at most {} are believed",
               width, height, bytes_.size(), most);
    }
    constexpr std::uint64_t k_bytes_a_pixel = 32;
    std::uint64_t row = static_cast<std::uint64_t>(data.width());
    std::uint64_t rows = static_cast<std::uint64_t>(k_chunk_rows[part.compression]);
    if (part.tiles) {
      row = ceil_div(row, part.tiles->width) * part.tiles->width;
      rows = part.tiles->height;
    }
    if (rows > most || row > most || row * rows > most * k_bytes_a_pixel / part.pixel_bytes)
      refuse("its header wants rows of {} x {} pixels of {} bytes at once, from {} bytes", row,
             rows, part.pixel_bytes, bytes_.size());
  }

  static std::uint64_t ceil_div(std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; }

  /// Sizes of the levels of one axis.
  static std::vector<std::uint64_t> level_sizes(std::uint64_t size, bool round_up) {
    std::vector<std::uint64_t> sizes{size};
    while (sizes.back() > 1)
      sizes.push_back(round_up ? ceil_div(sizes.back(), 2) : sizes.back() / 2);
    return sizes;
  }

  static std::uint64_t count_tiles(const Part& part) {
    const Tiles& tiles = *part.tiles;
    const auto width = static_cast<std::uint64_t>(part.header.data.width());
    const auto height = static_cast<std::uint64_t>(part.header.data.height());
    const auto count = [&](std::uint64_t w, std::uint64_t h) {
      return ceil_div(w, tiles.width) * ceil_div(h, tiles.height);
    };
    if (tiles.mode == 0) return count(width, height);
    const auto widths = level_sizes(width, tiles.round_up);
    const auto heights = level_sizes(height, tiles.round_up);
    std::uint64_t sum = 0;
    if (tiles.mode == 1) {
      for (std::size_t l = 0; l < std::max(widths.size(), heights.size()); ++l)
        sum += count(l < widths.size() ? widths[l] : 1, l < heights.size() ? heights[l] : 1);
      return sum;
    }
    for (const std::uint64_t w : widths)
      for (const std::uint64_t h : heights)
        sum += count(w, h);
    return sum;
  }

  static std::uint64_t count_chunks(const Part& part) {
    if (part.tiles) return count_tiles(part);
    return ceil_div(static_cast<std::uint64_t>(part.header.data.height()),
                    static_cast<std::uint64_t>(k_chunk_rows[part.compression]));
  }

  /// All parts' tables fit; then those chunks of the first that hold its full resolution, which
  /// come first in its table.
  void check_chunks(const Part& first) {
    const std::size_t table = at_;
    std::uint64_t tables = 0;
    for (const Part& part : parts_) {
      const std::uint64_t promised = count_chunks(part);
      // The library believes the attribute.
      if (part.chunk_count && multi_part_ &&
          static_cast<std::uint64_t>(std::max(*part.chunk_count, 0)) != promised)
        refuse("its header promises {} chunks of {}", *part.chunk_count, promised);
      if (promised > left() / 8) refuse("cut off: its header promises {} chunks", promised);
      tables += promised * 8;
    }
    if (tables > left()) refuse("cut off in the table of its chunks");
    const std::size_t body = table + static_cast<std::size_t>(tables);
    if (first.tiles) {
      check_tiles(first, table, body);
      return;
    }
    const std::uint64_t chunks = count_chunks(first);
    const std::int64_t rows = k_chunk_rows[first.compression];
    for (std::uint64_t i = 0; i < chunks; ++i) {
      const std::int64_t y = first.header.data.y0 + static_cast<std::int64_t>(i) * rows;
      const std::int64_t height = std::min(rows, std::int64_t{first.header.data.y1} - y + 1);
      const std::int32_t place[] = {static_cast<std::int32_t>(y)};
      check_chunk(first, table + static_cast<std::size_t>(i) * 8, body, place,
                  static_cast<std::uint64_t>(height * first.header.data.width()));
    }
  }

  void check_tiles(const Part& part, std::size_t table, std::size_t body) {
    const auto width = static_cast<std::uint64_t>(part.header.data.width());
    const auto height = static_cast<std::uint64_t>(part.header.data.height());
    const std::uint64_t columns = ceil_div(width, part.tiles->width);
    const std::uint64_t rows = ceil_div(height, part.tiles->height);
    for (std::uint64_t i = 0; i < columns * rows; ++i) {
      const std::uint64_t x = i % columns, y = i / columns;
      const std::int32_t place[] = {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), 0,
                                    0};
      const std::uint64_t w =
          std::min<std::uint64_t>(part.tiles->width, width - x * part.tiles->width);
      const std::uint64_t h =
          std::min<std::uint64_t>(part.tiles->height, height - y * part.tiles->height);
      check_chunk(part, table + static_cast<std::size_t>(i) * 8, body, place, w * h);
    }
  }

  /// `place`: what the chunk says of where it belongs.
  void check_chunk(const Part& part, std::size_t entry, std::size_t body,
                   std::span<const std::int32_t> place, std::uint64_t pixels) {
    const std::uint64_t offset = number_at<std::uint64_t>(entry);
    const std::size_t head = (place.size() + 1 + (multi_part_ ? 1 : 0)) * 4;
    if (offset < body || offset > bytes_.size() || head > bytes_.size() - offset)
      refuse("cut off: the chunk at {} is not there", fmt::join(place, ", "));
    auto at = static_cast<std::size_t>(offset);
    bool right = true;
    if (multi_part_) {
      right = number_at<std::int32_t>(at) == 0;
      at += 4;
    }
    for (const std::int32_t wanted : place) {
      right = right && number_at<std::int32_t>(at) == wanted;
      at += 4;
    }
    if (!right) refuse("the chunk at {} is another", fmt::join(place, ", "));
    const auto size = number_at<std::int32_t>(at);
    at += 4;
    if (size <= 0 || static_cast<std::size_t>(size) > bytes_.size() - at)
      refuse("cut off: the chunk at {} promises {} bytes, {} follow", fmt::join(place, ", "), size,
             bytes_.size() - at);
    const std::uint64_t whole = pixels * part.pixel_bytes;
    const auto held = static_cast<std::uint64_t>(size);
    const std::uint64_t found = part.compression == k_rle && held < whole
                                    ? unrolled(bytes_.subspan(at, static_cast<std::size_t>(size)))
                                : part.compression == k_none ? held
                                                             : whole;
    // The library would leave what the rest of its buffer held before.
    if (found != whole)
      refuse("the chunk at {} holds {} bytes of {}", fmt::join(place, ", "), found, whole);
  }

  /// How many bytes run-length encoding unrolls to: -n and n bytes, or n and one byte n + 1 times.
  static std::uint64_t unrolled(std::span<const std::byte> data) {
    std::uint64_t size = 0;
    for (std::size_t at = 0; at + 1 < data.size();) {
      const int byte = std::to_integer<int>(data[at]);
      const int run = byte < 128 ? byte : byte - 256;
      size += static_cast<std::uint64_t>(run < 0 ? -run : run + 1);
      at += run < 0 ? 1 + static_cast<std::size_t>(-run) : 2;
    }
    return size;
  }

  std::span<const std::byte> bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
  bool multi_part_ = false;
  std::vector<Part> parts_;
};

}  // namespace

bool is_exr(std::span<const std::byte> bytes) {
  std::uint32_t magic = 0;
  if (bytes.size() < 8) return false;
  std::memcpy(&magic, bytes.data(), sizeof magic);
  return magic == k_magic;
}

ExrHeader read_exr_header(std::span<const std::byte> bytes, const std::string& name) {
  DS_ASSERT(is_exr(bytes));
  return Parser(bytes, name).parse();
}

}  // namespace ds
