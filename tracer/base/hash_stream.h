// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/hash.h"

#include <filesystem>
#include <string_view>

struct XXH3_state_s;

namespace ds {

/// XXH3-128 of texts one after the other: what `hash_text` gives for all of them in one, without
/// holding it.
class HashStream {
 public:
  HashStream();
  ~HashStream();
  HashStream(const HashStream&) = delete;
  HashStream& operator=(const HashStream&) = delete;

  void add(std::string_view text);
  /// The sixteen bytes of a hash, the high word first, each word's lowest byte first.
  void add(Hash128 hash);
  /// Of all that was added so far.
  Hash128 hash() const;

 private:
  XXH3_state_s* state_;
};

/// XXH3-128 of a file's bytes: `hash_file` without SHA-256, which takes ten times as long. Throws
/// Error(io) where the file cannot be read.
Hash128 content_hash(const std::filesystem::path& path);

}  // namespace ds
