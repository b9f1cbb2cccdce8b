// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/hash.h"

#include <cstdint>
#include <filesystem>

namespace ds {

/// A file on whose bytes processes lock each other out. The bytes need not be there: a lock is
/// about a number. Locks are of this open file, not of the process (those vanish when any
/// descriptor of the file closes), and the system drops them when the process ends, however it
/// ends. Every call throws Error(io) where the file system knows no locks.
class LockFile {
 public:
  /// Opens or makes the file and its folders. Throws Error(io).
  explicit LockFile(const std::filesystem::path& file);
  ~LockFile();
  LockFile(LockFile&& other) noexcept;
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;
  LockFile& operator=(LockFile&&) = delete;

  /// The byte that stands for a hash, in [1, 2^62]; two hashes that share one wait for each other.
  static long offset_of(Hash128 hash) {
    return static_cast<long>((hash.low & ((std::uint64_t{1} << 62) - 1)) + 1);
  }

  enum class Lock { shared, exclusive };
  /// Waits for others.
  void take(Lock lock, long offset);
  /// False where others hold what it needs.
  bool try_take(Lock lock, long offset);
  void release(long offset);
  /// Whether another open file has any lock on the bytes [from, to).
  bool others_hold(long from, long to) const;

  const std::filesystem::path& file() const { return file_; }
  int descriptor() const { return fd_; }

 private:
  bool set(short type, long offset);

  std::filesystem::path file_;
  int fd_;
};

}  // namespace ds
