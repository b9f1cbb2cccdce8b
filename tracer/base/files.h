// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// The whole file. Throws Error(io) with the path and the system's reason.
std::string read_text_file(const std::filesystem::path& path);

/// Replaces `path` with `bytes` so that a crash at any moment leaves the old file or the new one,
/// whole: temporary in the same folder -> fsync -> rename -> fsync of the folder. Makes missing
/// parent folders. Throws Error(io), and then neither the temporary nor a changed file stays
/// behind.
void write_file_atomic(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file_atomic(const std::filesystem::path& path, std::string_view text);

/// Makes `to` the same bytes as `from` without sharing later writes where the file system can
/// (reflink), else by a hard link, else by a copy; atomic as above. `from` must be a finished file
/// that nobody writes to again.
void link_file_atomic(const std::filesystem::path& from, const std::filesystem::path& to);

/// fsync of a folder, so that a rename in it survives a power cut. Throws Error(io).
void sync_folder(const std::filesystem::path& folder);

/// Makes the folder and its parents. Throws Error(io).
void make_folders(const std::filesystem::path& folder);

/// A fresh empty folder under the system's temporary folder, removed with all it holds when this
/// goes.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace ds
