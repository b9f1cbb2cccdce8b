// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace ds {

/// Files that are replaced together, each as `write_file_atomic` does: a crash at any moment leaves
/// of each the old file or the new one, whole, and after `commit` all are on the disk. It waits for
/// the disk twice (temporaries, then names) where one after the other each file would twice. What
/// is not committed leaves nothing behind. Where `commit` throws, some files may be the new ones.
/// All functions throw Error(io).
class FileBatch {
 public:
  FileBatch();
  ~FileBatch();
  FileBatch(const FileBatch&) = delete;
  FileBatch& operator=(const FileBatch&) = delete;

  void write(const std::filesystem::path& path, std::span<const std::byte> bytes);
  /// As link_file_atomic.
  void link(const std::filesystem::path& from, const std::filesystem::path& to);
  /// As copy_file_atomic.
  void copy(const std::filesystem::path& from, const std::filesystem::path& to);
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ds
