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

/// Makes `to` the same bytes as `from`; atomic as above. By a reflink, which shares no later write,
/// where the file system can; else by a hard link that this process may not write through, so that
/// no editor reaches `from`: `from` loses its write permissions. Where that is not enough (root
/// writes to any file) or there can be no further link (another file system, too many links), by a
/// copy.
void link_file_atomic(const std::filesystem::path& from, const std::filesystem::path& to);

/// Makes `to` a file of its own with the bytes of `from`; atomic as above.
void copy_file_atomic(const std::filesystem::path& from, const std::filesystem::path& to);

/// Whether this process may write to the file as its permissions are: root may to any.
bool may_write(const std::filesystem::path& file);

/// Takes everybody's write permission away; what is lost of that on a file of somebody else, or on
/// a file system without permissions, `may_write` tells.
void remove_write_permission(const std::filesystem::path& file);

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
