// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/hash.h"

#include "tracer/base/error.h"

#include <xxhash.h>

#include <array>
#include <cstdio>
#include <memory>
#include <openssl/evp.h>
#include <vector>

namespace ds {
namespace {

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
      hex += fmt::format("{:02x}", digest[i]);
    return hex;
  }

 private:
  static void check(bool ok) {
    if (!ok) fail(ErrorKind::io, "the cryptographic library refused SHA-256");
  }
  std::unique_ptr<EVP_MD_CTX, DigestDeleter> context_;
};

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct XxhDeleter {
  void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};

Hash128 from_xxh(XXH128_hash_t hash) {
  return {hash.high64, hash.low64};
}

}  // namespace

// By hand: a plan of 25,000 images reads and writes half a million of them.
std::string Hash128::hex() const {
  constexpr std::string_view k_digits = "0123456789abcdef";
  std::string text(32, '0');
  for (std::size_t i = 0; i < 32; ++i) {
    const std::uint64_t word = i < 16 ? high : low;
    text[i] = k_digits[(word >> (60 - 4 * (i % 16))) & 15];
  }
  return text;
}

std::optional<Hash128> Hash128::from_hex(std::string_view text) {
  if (text.size() != 32) return std::nullopt;
  std::array<std::uint64_t, 2> words{};
  for (std::size_t i = 0; i < 32; ++i) {
    const char c = text[i];
    const bool is_digit = c >= '0' && c <= '9';
    if (!is_digit && !(c >= 'a' && c <= 'f')) return std::nullopt;
    words[i / 16] =
        words[i / 16] << 4U | static_cast<std::uint64_t>(is_digit ? c - '0' : c - 'a' + 10);
  }
  return Hash128{words[0], words[1]};
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

std::string sha256_hex(std::span<const std::byte> bytes) {
  Sha256 sha;
  sha.update(bytes);
  return sha.finish();
}

FileHashes hash_file(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(ErrorKind::io, "{}: cannot be opened for reading", path.string());
  const std::unique_ptr<XXH3_state_t, XxhDeleter> state(XXH3_createState());
  DS_ASSERT(state != nullptr && XXH3_128bits_reset(state.get()) == XXH_OK);
  Sha256 sha;
  FileHashes result;
  std::vector<std::byte> block(1 << 16);
  while (const std::size_t got = std::fread(block.data(), 1, block.size(), file.get())) {
    XXH3_128bits_update(state.get(), block.data(), got);
    sha.update(std::span(block).first(got));
    result.size_bytes += got;
  }
  if (std::ferror(file.get()) != 0) fail(ErrorKind::io, "{}: cannot be read", path.string());
  result.xxh128 = from_xxh(XXH3_128bits_digest(state.get()));
  result.sha256 = sha.finish();
  return result;
}

}  // namespace ds
