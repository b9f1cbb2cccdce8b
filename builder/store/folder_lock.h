// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/lock_file.h"

#include <filesystem>
#include <optional>
#include <string>

namespace ds {

/// Builds of one dataset's folder: any number at once that make the same of it (shards, or a build
/// started twice), else one after another, since each would remove what the others make. On the
/// file `build` of `.dsbuild`, whose text names who builds. Byte 0 is held while a build joins or enters
/// the folder, byte 1 + k by those who make plan number k.
class FolderLock {
 public:
  /// `folder`: Dataset::lock_folder, which it makes. Throws Error(io).
  explicit FolderLock(const std::filesystem::path& folder);

  /// Held while the folder's owner is looked at and entered.
  class Gate {
   public:
    explicit Gate(FolderLock& lock);
    ~Gate();
    Gate(const Gate&) = delete;
    Gate& operator=(const Gate&) = delete;

   private:
    FolderLock& lock_;
  };

  /// Joins those who make `what` of the folder, until this goes or `leave`. Else the text of
  /// somebody who makes something else.
  std::optional<std::string> try_join(Hash128 what, const std::string& who);
  void leave();

 private:
  LockFile file_;
  std::optional<long> held_;
};

}  // namespace ds
