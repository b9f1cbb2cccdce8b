// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/hash.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"

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

TEST(HashTest, file_equals_memory_over_a_block_border) {
  const TemporaryFolder folder;
  std::string text(100001, '\0');
  std::generate(text.begin(), text.end(), [i = 0]() mutable { return static_cast<char>(i++ * 7); });
  write_file_atomic(folder.path() / "f", text);
  const FileHashes hashes = hash_file(folder.path() / "f");
  EXPECT_EQ(hashes.xxh128, hash_text(text));
  EXPECT_EQ(hashes.sha256, sha256_hex(bytes_of(text)));
  EXPECT_EQ(hashes.size_bytes, text.size());
  EXPECT_THROW(hash_file(folder.path() / "none"), Error);
}

}  // namespace
}  // namespace ds
