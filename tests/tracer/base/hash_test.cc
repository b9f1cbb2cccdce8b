// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/hash.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/hash_stream.h"
#include "tracer/base/hex_text.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ds {
namespace {

// Published vectors: XXH3-128 of no bytes (xxHash's own sanity table), SHA-256 of "abc" (FIPS
// 180-4).
TEST(HashTest, known_vectors) {
  EXPECT_EQ(hash_text("").hex(), "99aa06d3014798d86001c324468d497f");
  EXPECT_EQ(sha256_hex(bytes_of("abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(HashTest, hex_round_trip_and_refusals) {
  const Hash128 hash = hash_text("dsbuild");
  EXPECT_EQ(Hash128::from_hex(hash.hex()), hash);
  EXPECT_FALSE(Hash128::from_hex(""));
  EXPECT_FALSE(Hash128::from_hex(hash.hex() + "0"));
  std::string upper = hash.hex();
  upper[3] = 'G';
  EXPECT_FALSE(Hash128::from_hex(upper));
}

// The digits of a number written by the standard library, high word first.
TEST(HashTest, hex_is_that_of_the_two_words) {
  for (const Hash128 hash : {Hash128{0, 0}, Hash128{0x0123456789abcdefU, 0xfedcba9876543210U},
                             Hash128{~std::uint64_t{0}, 1}}) {
    const std::string wanted = fmt::format("{:016x}{:016x}", hash.high, hash.low);
    EXPECT_EQ(hash.hex(), wanted);
    EXPECT_EQ(HexText(hash).text(), wanted);
    EXPECT_EQ(Hash128::from_hex(wanted), hash);
  }
  EXPECT_EQ(HexText().text(), std::string(32, '0'));
}

TEST(HashTest, every_byte_but_the_sixteen_digits_is_refused_anywhere) {
  const std::string digits = "0123456789abcdef";
  for (int byte = 0; byte < 256; ++byte)
    for (const std::size_t place : {std::size_t{0}, std::size_t{15}, std::size_t{31}}) {
      std::string text(32, '7');
      text[place] = static_cast<char>(byte);
      EXPECT_EQ(Hash128::from_hex(text).has_value(), digits.find(text[place]) != digits.npos)
          << byte << " at " << place;
    }
}

TEST(HashTest, a_stream_is_the_hash_of_all_its_texts) {
  std::string all;
  HashStream stream;
  EXPECT_EQ(stream.hash(), hash_text(""));
  for (std::size_t size = 0; size < 2000; size += 37) {
    const std::string piece(size, static_cast<char>('a' + size % 26));
    all += piece;
    stream.add(piece);
    EXPECT_EQ(stream.hash(), hash_text(all)) << size;
  }
  stream.add(Hash128{0x0807060504030201U, 0x100f0e0d0c0b0a09U});
  for (char byte = 1; byte <= 16; ++byte)
    all += byte;
  EXPECT_EQ(stream.hash(), hash_text(all));
}

TEST(HashTest, file_equals_memory_over_a_block_border) {
  const TemporaryFolder folder;
  std::string text(100001, '\0');
  std::generate(text.begin(), text.end(), [i = 0]() mutable { return static_cast<char>(i++ * 7); });
  write_file_atomic(folder.path() / "f", text);
  const FileHashes hashes = hash_file(folder.path() / "f");
  EXPECT_EQ(hashes.xxh128, hash_text(text));
  EXPECT_EQ(hashes.sha256, sha256_hex(bytes_of(text)));
  EXPECT_EQ(hashes.size_bytes, text.size());
  EXPECT_EQ(content_hash(folder.path() / "f"), hash_text(text));
  EXPECT_THROW(hash_file(folder.path() / "none"), Error);
  EXPECT_THROW(content_hash(folder.path() / "none"), Error);
}

}  // namespace
}  // namespace ds
