// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/film_file.h"

#include "tracer/base/canonical.h"
#include "tracer/base/error.h"
#include "tracer/base/hash.h"
#include "tracer/kernels/layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

namespace ds {
namespace {

constexpr std::string_view k_magic = "dsbuild film 2\n";
constexpr std::array<const char*, 5> k_names{"width", "height", "planes", "tone_scale",
                                             "least_bound"};
constexpr int k_most_pixels_a_side = 16384;
constexpr std::size_t k_checksum_bytes = 16;
constexpr float k_most_count = 0x1p24f;  // a float counts no further

void put_u32(std::vector<std::byte>& to, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8)
    to.push_back(static_cast<std::byte>(value >> shift & 0xffu));
}

void put_checksum(std::vector<std::byte>& to, Hash128 hash) {
  for (const std::uint64_t word : {hash.high, hash.low})
    for (int shift = 56; shift >= 0; shift -= 8)
      to.push_back(static_cast<std::byte>(word >> shift & 0xffu));
}

std::vector<int> planes_with_values(const FilmSums& film) {
  std::vector<int> planes;
  for (int i = 0; i < kernels::k_film_planes; ++i)
    for (std::size_t tile = 0; tile < film.tile_spp.size(); ++tile) {
      const auto row = film.row(tile, static_cast<std::size_t>(i));
      if (std::all_of(row.begin(), row.end(),
                      [](float v) { return std::bit_cast<std::uint32_t>(v) == 0; }))
        continue;
      planes.push_back(i);
      break;
    }
  return planes;
}

std::string head_of(int width, int height, const std::vector<int>& planes,
                    const ScheduleState& schedule) {
  const std::string values[] = {std::to_string(width), std::to_string(height),
                                fmt::format("{}", fmt::join(planes, " ")),
                                schedule.tone_scale ? hex_float(*schedule.tone_scale) : "none",
                                hex_float(schedule.least_bound)};
  std::string head(k_magic);
  for (std::size_t i = 0; i < k_names.size(); ++i)
    head += fmt::format("{}={}\n", k_names[i], values[i]);
  return head + '\n';
}

/// What is left to read of a file; every taking is checked.
class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const std::string& name) : rest_(bytes), name_(name) {}

  [[noreturn]] void refuse(std::string_view why) const {
    fail(ErrorKind::asset, "{}: no film of this version: {}", name_, why);
  }
  std::span<const std::byte> take(std::size_t count) {
    if (rest_.size() < count) refuse("it is cut off");
    const auto taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  std::string line() {
    const auto end = std::find(rest_.begin(), rest_.end(), std::byte{'\n'});
    if (end == rest_.end()) refuse("its head has no end");
    std::string text;
    for (const std::byte b : take(static_cast<std::size_t>(end - rest_.begin())))
      text.push_back(static_cast<char>(b));
    take(1);
    return text;
  }
  /// The value of a line "name=value".
  std::string value(std::string_view wanted) {
    const std::string text = line();
    if (!text.starts_with(std::string(wanted) + "="))
      refuse(fmt::format("wanted {}=..., found {:?}", wanted, text));
    return text.substr(wanted.size() + 1);
  }
  std::uint32_t u32() {
    std::uint32_t value = 0;
    int shift = 0;
    for (const std::byte b : take(4)) {
      value |= std::to_integer<std::uint32_t>(b) << shift;
      shift += 8;
    }
    return value;
  }
  bool at_end() const { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
  const std::string& name_;
};

int number(const Reader& reader, const std::string& text, int least, int most) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < least || value > most)
    reader.refuse(fmt::format("wanted a number in [{}, {}], found {:?}", least, most, text));
  return value;
}

double hex_number(const Reader& reader, const std::string& text) {
  double value = 0;
  const char* begin = text.data() + (text.starts_with("0x") ? 2 : 0);
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(begin, last, value, std::chars_format::hex);
  if (error != std::errc() || end != last || begin == text.data() || !std::isfinite(value) ||
      std::signbit(value))
    reader.refuse(fmt::format("wanted a hexadecimal float >= 0, found {:?}", text));
  return value;
}

std::vector<int> plane_list(const Reader& reader, const std::string& text) {
  std::vector<int> planes;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    planes.push_back(number(reader, word, 0, kernels::k_film_planes - 1));
    if (planes.size() > 1 && planes[planes.size() - 2] >= planes.back())
      reader.refuse("its planes are out of order");
  }
  // A sample is counted in one at least. So a film takes at most 46 times what is there of it.
  if (planes.empty()) reader.refuse("it holds no samples");
  return planes;
}

std::span<const std::byte> checked(std::span<const std::byte> bytes, const std::string& name) {
  const Reader reader(bytes, name);
  if (bytes.size() < k_checksum_bytes) reader.refuse("it is cut off");
  const auto content = bytes.first(bytes.size() - k_checksum_bytes);
  std::vector<std::byte> checksum;
  put_checksum(checksum, hash_bytes(content));
  if (!std::equal(checksum.begin(), checksum.end(), bytes.last(k_checksum_bytes).begin()))
    reader.refuse("its checksum is another");
  return content;
}

}  // namespace

std::vector<std::byte> encode_film_sums(const FilmSums& film) {
  DS_ASSERT(!film.empty());
  const std::vector<int> planes = planes_with_values(film);
  DS_ASSERT(!planes.empty());
  const std::string head = head_of(film.width, film.height, planes, film.schedule);
  const auto text = bytes_of(head);
  std::vector<std::byte> bytes(text.begin(), text.end());
  bytes.reserve(bytes.size() +
                4 * film.tile_spp.size() * (1 + planes.size() * kernels::k_tile_pixels) +
                k_checksum_bytes);
  for (const std::uint32_t spp : film.tile_spp)
    put_u32(bytes, spp);
  for (const int plane : planes)
    for (std::size_t tile = 0; tile < film.tile_spp.size(); ++tile)
      for (const float value : film.row(tile, static_cast<std::size_t>(plane)))
        put_u32(bytes, std::bit_cast<std::uint32_t>(value));
  put_checksum(bytes, hash_bytes(bytes));
  return bytes;
}

FilmSums decode_film_sums(std::span<const std::byte> bytes, const std::string& name) {
  const auto content = checked(bytes, name);
  Reader reader(content, name);
  if (reader.line() + '\n' != k_magic) reader.refuse("it begins otherwise");
  const int width = number(reader, reader.value(k_names[0]), 1, k_most_pixels_a_side);
  const int height = number(reader, reader.value(k_names[1]), 1, k_most_pixels_a_side);
  const std::vector<int> planes = plane_list(reader, reader.value(k_names[2]));
  ScheduleState schedule;
  const std::string tone_scale = reader.value(k_names[3]);
  if (tone_scale != "none") schedule.tone_scale = hex_number(reader, tone_scale);
  const std::string least_bound = reader.value(k_names[4]);
  if (least_bound != "inf") schedule.least_bound = hex_number(reader, least_bound);
  if (!reader.line().empty()) reader.refuse("its head is longer");
  // The numbers taken have other spellings, such as 07 for 7, beside the one written.
  const std::string head = head_of(width, height, planes, schedule);
  if (!std::ranges::equal(content.first(std::min(head.size(), content.size())), bytes_of(head)))
    reader.refuse("its head is spelled otherwise");
  // Before anything is allocated for a size that a damaged head claims.
  const std::size_t tiles = FilmSums::tiles_along(width) * FilmSums::tiles_along(height);
  Reader values(reader.take(4 * tiles * (1 + planes.size() * kernels::k_tile_pixels)), name);
  if (!reader.at_end()) reader.refuse("it is longer");
  FilmSums film = empty_film(width, height);
  film.schedule = schedule;
  for (std::uint32_t& spp : film.tile_spp)
    spp = values.u32();
  for (const int plane : planes) {
    std::uint32_t set = 0;
    const bool is_count = plane >= kernels::k_film_nan && plane <= kernels::k_film_outliers;
    for (std::size_t tile = 0; tile < tiles; ++tile)
      for (float& value : film.row(tile, static_cast<std::size_t>(plane))) {
        const std::uint32_t bits = values.u32();
        set |= bits;
        value = std::bit_cast<float>(bits);
        if (!std::isfinite(value)) reader.refuse("it holds a value that is not finite");
        if (plane >= kernels::k_film_nan && value < 0) reader.refuse("it holds a count below 0");
        if (is_count && value > k_most_count) reader.refuse("it holds a count that is too large");
      }
    if (set == 0) reader.refuse("it lists a plane that is all zero");
  }
  return film;
}

}  // namespace ds
