// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/regular_file.h"

#include "tracer/base/error.h"

#include <cerrno>
#include <sys/stat.h>

namespace ds {
namespace {

const char* name_of(mode_t mode) {
  switch (mode & S_IFMT) {
    case S_IFDIR:
      return "a folder";
    case S_IFIFO:
      return "a pipe";
    case S_IFSOCK:
      return "a socket";
    default:
      return "a device";
  }
}

[[noreturn]] void fail_irregular(const std::filesystem::path& path, mode_t mode) {
  fail(ErrorKind::io, "{}: wanted a file, found {}", path.string(), name_of(mode));
}

}  // namespace

std::optional<std::string> what_is_no_file(const std::filesystem::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0 || S_ISREG(info.st_mode)) return std::nullopt;
  return name_of(info.st_mode);
}

Descriptor open_regular(const std::filesystem::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode))
    fail_irregular(path, info.st_mode);
  // What has come to stand there since is not waited for either. A file that another machine leases
  // (EWOULDBLOCK) is given back soon.
  int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0 && errno == EWOULDBLOCK)
    descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
  Descriptor file(descriptor, path);
  if (::fstat(file.get(), &info) != 0) fail_errno(path, "look at");
  if (!S_ISREG(info.st_mode)) fail_irregular(path, info.st_mode);
  return file;
}

std::ifstream regular_stream(const std::filesystem::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode))
    fail_irregular(path, info.st_mode);
  return std::ifstream(path, std::ios::binary);
}

}  // namespace ds
