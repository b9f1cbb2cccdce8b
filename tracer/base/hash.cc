// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/hash.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/error.h"
#include "tracer/base/hash_stream.h"
#include "tracer/base/hex_text.h"
#include "tracer/base/regular_file.h"

#include <xxhash.h>

#include <array>
#include <memory>
#include <openssl/evp.h>
#include <vector>

namespace ds {
namespace {

constexpr std::string_view k_digits = "0123456789abcdef";

struct DigestDeleter {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new()) {
    check(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void update(std::span<const std::byte> bytes) {
    check(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
  }
  std::string finish() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int size = 0;
    check(EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1);
    std::string hex;
    for (unsigned int i = 0; i < size; ++i)
      for (const unsigned digit : {digest[i] / 16U, digest[i] % 16U})
        hex += k_digits[digit];
    return hex;
  }

 private:
  static void check(bool ok) {
    if (!ok) fail(ErrorKind::io, "the cryptographic library refused SHA-256");
  }
  std::unique_ptr<EVP_MD_CTX, DigestDeleter> context_;
};

Hash128 from_xxh(XXH128_hash_t hash) {
  return {hash.high64, hash.low64};
}

// By tables: a plan of 25,000 images reads and writes half a million hashes as text.

constexpr auto k_byte_digits = [] {
  std::array<std::array<char, 2>, 256> digits{};
  for (std::size_t byte = 0; byte < 256; ++byte)
    digits[byte] = {k_digits[byte / 16], k_digits[byte % 16]};
  return digits;
}();

constexpr unsigned char k_no_digit = 16;
constexpr auto k_digit_values = [] {
  std::array<unsigned char, 256> values{};
  values.fill(k_no_digit);
  for (unsigned char digit = 0; digit < 16; ++digit)
    values[static_cast<unsigned char>(k_digits[digit])] = digit;
  return values;
}();

}  // namespace

HexText::HexText(Hash128 hash) {
  std::size_t at = 0;
  for (const std::uint64_t word : {hash.high, hash.low})
    for (int shift = 56; shift >= 0; shift -= 8) {
      const std::array<char, 2> pair = k_byte_digits[(word >> shift) & 255];
      digits_[at++] = pair[0];
      digits_[at++] = pair[1];
    }
}

std::string Hash128::hex() const {
  return std::string(HexText(*this).text());
}

std::optional<Hash128> Hash128::from_hex(std::string_view text) {
  if (text.size() != 32) return std::nullopt;
  unsigned all = 0;
  const auto word = [&](const char* digits) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 16; ++i) {
      const unsigned digit = k_digit_values[static_cast<unsigned char>(digits[i])];
      all |= digit;
      value = value << 4U | digit;  // of no digit it is not used
    }
    return value;
  };
  const Hash128 hash{word(text.data()), word(text.data() + 16)};
  if (all >= k_no_digit) return std::nullopt;
  return hash;
}

Hash128 hash_bytes(std::span<const std::byte> bytes) {
  return from_xxh(XXH3_128bits(bytes.data(), bytes.size()));
}

Hash128 hash_text(std::string_view text) {
  return hash_bytes(bytes_of(text));
}

std::uint64_t hash64_text(std::string_view text) {
  return XXH3_64bits(text.data(), text.size());
}

HashStream::HashStream() : state_(XXH3_createState()) {
  DS_ASSERT(state_ != nullptr && XXH3_128bits_reset(state_) == XXH_OK);
}

HashStream::~HashStream() {
  XXH3_freeState(state_);
}

void HashStream::add(std::string_view text) {
  XXH3_128bits_update(state_, text.data(), text.size());
}

void HashStream::add(Hash128 hash) {
  std::array<char, 16> bytes{};
  std::size_t at = 0;
  for (const std::uint64_t word : {hash.high, hash.low})
    for (int shift = 0; shift < 64; shift += 8)
      bytes[at++] = static_cast<char>((word >> shift) & 0xff);
  add(std::string_view(bytes.data(), bytes.size()));
}

Hash128 HashStream::hash() const {
  return from_xxh(XXH3_128bits_digest(state_));
}

std::string sha256_hex(std::span<const std::byte> bytes) {
  Sha256 sha;
  sha.update(bytes);
  return sha.finish();
}

namespace {

/// Calls `visit` with the file's bytes, a block after the other.
template <typename Visit>
void visit_blocks(const std::filesystem::path& path, const Visit& visit) {
  try {
    const Descriptor file = open_regular(path);
    std::vector<char> block(1 << 16);
    while (const std::size_t got = file.read(block))
      visit(std::string_view(block.data(), got));
  } catch (const DiskFailed& error) {  // a bad block of one file is no reason to write no other
    fail(ErrorKind::io, "{}", error.what());
  }
}

}  // namespace

FileHashes hash_file(const std::filesystem::path& path) {
  HashStream stream;
  Sha256 sha;
  FileHashes result;
  visit_blocks(path, [&](std::string_view block) {
    stream.add(block);
    sha.update(bytes_of(block));
    result.size_bytes += block.size();
  });
  result.xxh128 = stream.hash();
  result.sha256 = sha.finish();
  return result;
}

Hash128 content_hash(const std::filesystem::path& path) {
  HashStream stream;
  visit_blocks(path, [&](std::string_view block) { stream.add(block); });
  return stream.hash();
}

}  // namespace ds
