// SPDX-License-Identifier: Apache-2.0
#include "builder/db/file_stamp.h"

#include "tracer/base/error.h"

#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>

namespace ds {
namespace {

constexpr std::int64_t k_ns_per_s = 1'000'000'000;
/// The slowest tick of a file system in use is FAT's, two seconds.
constexpr std::int64_t k_racy_ns = 5 * k_ns_per_s / 2;

std::int64_t ns_of(const timespec& time) {
  return std::int64_t{time.tv_sec} * k_ns_per_s + time.tv_nsec;
}

}  // namespace

std::optional<FileStamp> stamp_of(const std::filesystem::path& file) {
  return stamp_in(AT_FDCWD, file.c_str());
}

std::optional<FileStamp> stamp_in(int folder, const char* path) {
  struct stat status = {};
  if (::fstatat(folder, path, &status, 0) != 0) {
    if (errno == ENOENT || errno == ENOTDIR || errno == ENAMETOOLONG) return std::nullopt;
    fail(ErrorKind::io, "{}: cannot look at the file: {}", path,
         std::generic_category().message(errno));
  }
  if (!S_ISREG(status.st_mode)) return std::nullopt;
  return FileStamp{static_cast<std::uint64_t>(status.st_size), ns_of(status.st_mtim),
                   ns_of(status.st_ctim), std::uint64_t{status.st_ino}};
}

std::int64_t now_ns() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

bool is_racy(const FileStamp& stamp) {
  return is_racy(stamp, now_ns());
}

bool is_racy(const FileStamp& stamp, std::int64_t now_ns) {
  // mtime counts too, for file systems whose ctime is that of creation (FAT before Linux 5.18),
  // unless it was set to a time to come.
  const bool written_now = stamp.mtime_ns > now_ns - k_racy_ns && stamp.mtime_ns <= now_ns;
  return written_now || stamp.ctime_ns > now_ns - k_racy_ns;
}

}  // namespace ds
