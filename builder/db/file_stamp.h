// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace ds {

/// What says, without reading a file, that it is the one read before: as git's index and ccache do.
struct FileStamp {
  std::uint64_t size_bytes = 0;
  std::int64_t mtime_ns = 0;  ///< since 1970
  std::uint64_t inode = 0;

  bool operator==(const FileStamp&) const = default;
};

/// Nothing where there is no such file (or it is no regular file). Throws Error(io) where the
/// system cannot tell.
std::optional<FileStamp> stamp_of(const std::filesystem::path& file);

/// Whether the file was last written so recently that a further write could leave the same stamp:
/// file systems tick in milliseconds, so two writes of one tick look alike (git calls such an entry
/// racily clean). Such a stamp must not be remembered.
bool is_racy(const FileStamp& stamp);

}  // namespace ds
