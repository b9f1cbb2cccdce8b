// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/file_stamp.h"

#include <filesystem>
#include <optional>

namespace ds {

/// Remembers that a database file was found whole, so that a command with nothing to do need not
/// read all of it (0.4 s for 25,000 images). The stamp the file had when the last process closed it
/// stands beside it in FILE-checked: four numbers, size, mtime, ctime and inode. Where the stamp is
/// another one (something else than SQLite wrote the file, a copy, another machine), where SQLite's
/// log was left behind (a kill, a power cut) or is in use, and after any error the file is checked
/// anew. A disk's own fault under an old stamp is found by SQLite when it reads the page.
class FileCheck {
 public:
  /// Before the file is opened. An empty path: nothing is needed.
  explicit FileCheck(std::filesystem::path file);
  bool needed() const { return needed_; }
  /// After the file was checked, or did not need it, and was closed. While an exception is on its
  /// way the mark is taken away instead.
  void passed();

 private:
  std::filesystem::path mark() const;
  bool log_is_empty() const;

  std::filesystem::path file_;
  std::optional<FileStamp> stamp_;  ///< in the mark
  bool needed_ = false;
  int exceptions_;
};

}  // namespace ds
