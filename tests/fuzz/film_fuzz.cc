// SPDX-License-Identifier: Apache-2.0
// Kept films: a film that is written as the very bytes it was read from, or an Error.
#include "tracer/base/error.h"
#include "tracer/base/hash.h"
#include "tracer/kernels/layout.h"
#include "tracer/render/film_file.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace {

void read(std::span<const std::byte> bytes) {
  try {
    const ds::FilmSums film = ds::decode_film_sums(bytes, "fuzz.film");
    // A head cannot claim much more memory than there are bytes: a plane at least is there.
    DS_ASSERT(film.planes.size() <= ds::kernels::k_film_planes * bytes.size() / sizeof(float));
    DS_ASSERT(std::ranges::equal(ds::encode_film_sums(film), bytes));
  } catch (const ds::Error& error) {
    DS_ASSERT(error.kind() == ds::ErrorKind::asset);
  }
}

}  // namespace

/// The bytes as they are, and with the right checksum, so that every input gets behind that.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  read(bytes);
  const auto content = bytes.first(size - std::min(size, std::size_t{16}));
  std::vector<std::byte> right(content.begin(), content.end());
  const ds::Hash128 hash = ds::hash_bytes(content);
  for (const std::uint64_t word : {hash.high, hash.low})
    for (int shift = 56; shift >= 0; shift -= 8)
      right.push_back(static_cast<std::byte>(word >> shift & 0xffu));
  read(right);
  return 0;
}
