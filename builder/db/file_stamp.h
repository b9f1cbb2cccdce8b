// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace ds {

/// What says, without reading a file, that it is the one read before: as git's index and ccache do.
/// Programs that copy a file with its times (cp -p, tar, rsync) set mtime and keep the inode; only
/// ctime is the system's own. It moves too where nothing but a mode, an owner or the number of hard
/// links changed: the file is then read once more for nothing. The device is left out, since its
/// number changes from one mount to the next.
struct FileStamp {
  std::uint64_t size_bytes = 0;
  std::int64_t mtime_ns = 0;  ///< since 1970
  std::int64_t ctime_ns = 0;  ///< since 1970
  std::uint64_t inode = 0;

  bool operator==(const FileStamp&) const = default;
};

/// Nothing where there is no such file (or it is no regular file). Throws Error(io) where the
/// system cannot tell.
std::optional<FileStamp> stamp_of(const std::filesystem::path& file);
/// The same of a path relative to an open folder's descriptor; for thousands of files, since it
/// takes no path apart.
std::optional<FileStamp> stamp_in(int folder, const char* path);

/// Whether the file was last written so recently that a further write could leave the same stamp:
/// two writes of one tick of the file system's clock look alike (git calls such an entry racily
/// clean). Such a stamp must not be remembered. A file from the future (a clock that was set back)
/// stays so until its time has come.
bool is_racy(const FileStamp& stamp);
/// The same, seen from a moment, nanoseconds since 1970.
bool is_racy(const FileStamp& stamp, std::int64_t now_ns);
std::int64_t now_ns();

}  // namespace ds
