// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/tiff_directory.h"

#include "tracer/base/error.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace ds {
namespace {

/// Tags, and types of their values (2 and 4 bytes).
constexpr std::uint32_t k_bits = 258, k_strips = 273, k_strip_bytes = 279, k_tiles = 324,
                        k_tile_bytes = 325;
constexpr std::uint32_t k_short = 3, k_long = 4;

class Tiff {
 public:
  explicit Tiff(std::span<const std::byte> bytes)
      : bytes_(bytes), big_(bytes.size() > 1 && bytes[0] == std::byte{'M'}) {}

  std::uint64_t size() const { return bytes_.size(); }
  bool is_classic() const { return number(2, 2) == 42; }

  /// 0 behind the end.
  std::uint64_t number(std::uint64_t at, int width) const {
    std::uint64_t value = 0;
    for (int i = 0; i < width; ++i) {
      const std::uint64_t from = at + static_cast<std::uint64_t>(big_ ? i : width - 1 - i);
      const std::uint64_t byte =
          from < bytes_.size() ? std::to_integer<std::uint64_t>(bytes_[from]) : 0;
      value = value << 8U | byte;
    }
    return value;
  }

  /// Values of the first directory by tag; of types and counts that no picture has, none.
  std::map<std::uint32_t, std::vector<std::uint64_t>> directory() const {
    std::map<std::uint32_t, std::vector<std::uint64_t>> found;
    const std::uint64_t start = number(4, 4);
    const std::uint64_t entries = number(start, 2);
    for (std::uint64_t i = 0; i < entries; ++i) {
      const std::uint64_t at = start + 2 + 12 * i;
      if (at + 12 > size()) break;
      found[static_cast<std::uint32_t>(number(at, 2))] = values(at);
    }
    return found;
  }

 private:
  std::vector<std::uint64_t> values(std::uint64_t entry) const {
    const std::uint64_t type = number(entry + 2, 2), count = number(entry + 4, 4);
    const int width = type == k_short ? 2 : type == k_long ? 4 : 0;
    if (width == 0 || count * static_cast<std::uint64_t>(width) > size()) return {};
    const bool inside = count * static_cast<std::uint64_t>(width) <= 4;
    const std::uint64_t at = inside ? entry + 8 : number(entry + 8, 4);
    std::vector<std::uint64_t> values;
    for (std::uint64_t i = 0; i < count; ++i)
      values.push_back(number(at + i * static_cast<std::uint64_t>(width), width));
    return values;
  }

  std::span<const std::byte> bytes_;
  bool big_;
};

}  // namespace

void check_tiff(std::span<const std::byte> bytes, const std::string& name) {
  const Tiff tiff(bytes);
  if (!tiff.is_classic()) return;
  const auto entries = tiff.directory();
  const auto of = [&](std::uint32_t tag) {
    const auto at = entries.find(tag);
    return at == entries.end() ? std::vector<std::uint64_t>{} : at->second;
  };
  if (!entries.empty() && !entries.contains(k_bits))
    fail(ErrorKind::asset,
         "{}: a TIFF file that states no bits a sample has 1, which is not supported: save it with "
         "8",
         name);
  for (const auto& [starts, counts] :
       {std::pair(of(k_strips), of(k_strip_bytes)), std::pair(of(k_tiles), of(k_tile_bytes))})
    for (std::size_t i = 0; i < std::min(starts.size(), counts.size()); ++i)
      if (starts[i] > tiff.size() || counts[i] > tiff.size() - starts[i])
        fail(ErrorKind::asset,
             "{}: cannot be read as an image: the TIFF file is cut off: pixels at byte {} to {} of "
             "{}",
             name, starts[i], starts[i] + counts[i], tiff.size());
}

}  // namespace ds
