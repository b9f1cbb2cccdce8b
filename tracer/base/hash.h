// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ds {

/// XXH3-128 of some bytes. Compares and prints as the big-endian number that `xxhsum -H2` prints.
struct Hash128 {
  std::uint64_t high = 0;
  std::uint64_t low = 0;

  auto operator<=>(const Hash128&) const = default;
  /// 32 lower-case hexadecimal digits.
  std::string hex() const;
  /// Reads what `hex` writes; nothing for any other text.
  static std::optional<Hash128> from_hex(std::string_view text);
};

/// XXH3-128 with seed 0. Any size, empty included.
Hash128 hash_bytes(std::span<const std::byte> bytes);
Hash128 hash_text(std::string_view text);
/// XXH3-64 with seed 0; for seeds and seeded choices, never for identity.
std::uint64_t hash64_text(std::string_view text);

/// Both checksums of a file's bytes, read once in blocks.
struct FileHashes {
  Hash128 xxh128;
  std::string sha256;  ///< 64 lower-case hexadecimal digits
  std::uint64_t size_bytes = 0;
};
/// Throws Error(io) where the file cannot be read.
FileHashes hash_file(const std::filesystem::path& path);

/// SHA-256 (FIPS 180-4) as 64 lower-case hexadecimal digits.
std::string sha256_hex(std::span<const std::byte> bytes);

/// The bytes of a text or of a contiguous array of plain values.
inline std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace ds
