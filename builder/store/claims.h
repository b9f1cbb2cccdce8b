// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/lock_file.h"
#include "tracer/base/hash.h"

#include <filesystem>
#include <optional>
#include <utility>

namespace ds {

/// Locks between processes that share a store, on one file of it. A killed build blocks nobody.
///
/// One byte stands for "the database is open here" (shared by all, exclusive for whoever sets it
/// aside), one byte for each image that is being made, at an offset taken from its key, and one for
/// what is true of a dataset as a whole: its id and its manifest. Two keys that share an offset
/// only wait for each other.
class Claims {
 public:
  /// Opens or makes the file. Throws Error(io).
  explicit Claims(const std::filesystem::path& file) : file_(file) {}
  const std::filesystem::path& file() const { return file_.file(); }

  /// Held until it goes.
  class Claim {
   public:
    Claim(Claims& claims, long offset) : claims_(&claims), offset_(offset) {}
    Claim(Claim&& other) noexcept
        : claims_(std::exchange(other.claims_, nullptr)), offset_(other.offset_) {}
    Claim& operator=(Claim&&) = delete;
    ~Claim();

   private:
    Claims* claims_;
    long offset_;
  };

  /// Nothing where another process makes it now.
  std::optional<Claim> try_image(Hash128 key);
  /// Waits while another process enters a dataset of the store or writes a manifest.
  Claim own_datasets();
  /// Waits for whoever holds it exclusively.
  void share_database();
  /// Nothing is waited for: false where another process has the database open. Replaces the share.
  bool try_own_database();

 private:
  LockFile file_;
};

}  // namespace ds
