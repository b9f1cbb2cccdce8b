// SPDX-License-Identifier: Apache-2.0
#include "builder/store/lock_file.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/files.h"

#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <thread>
#include <unistd.h>
#include <utility>

namespace ds {
namespace {

/// Who asks again and again is seen to be alive, by who watches a build.
constexpr std::chrono::milliseconds k_poll{10};

struct flock range_of(short type, long from, long length) {
  struct flock range = {};
  range.l_type = type;
  range.l_whence = SEEK_SET;
  range.l_start = from;
  range.l_len = length;
  return range;
}

}  // namespace

LockFile::LockFile(const std::filesystem::path& file) : file_(file) {
  make_folders(file.parent_path());
  fd_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (fd_ < 0) fail_system(file, "open", errno);
}

LockFile::~LockFile() {
  if (fd_ >= 0) ::close(fd_);
}

LockFile::LockFile(LockFile&& other) noexcept
    : file_(std::move(other.file_)), fd_(std::exchange(other.fd_, -1)) {}

bool LockFile::set(short type, long offset) {
  struct flock range = range_of(type, offset, 1);
  while (::fcntl(fd_, F_OFD_SETLK, &range) != 0) {
    if (errno == EINTR) continue;
    if (errno == EAGAIN || errno == EACCES) return false;
    fail_system(file_, "lock", errno);
  }
  return true;
}

void LockFile::take(Lock lock, long offset) {
  while (!try_take(lock, offset))
    std::this_thread::sleep_for(k_poll);
}

bool LockFile::try_take(Lock lock, long offset) {
  return set(lock == Lock::shared ? F_RDLCK : F_WRLCK, offset);
}

void LockFile::release(long offset) {
  set(F_UNLCK, offset);
}

bool LockFile::others_hold(long from, long to) const {
  if (from >= to) return false;
  struct flock range = range_of(F_WRLCK, from, to - from);
  if (::fcntl(fd_, F_OFD_GETLK, &range) != 0) fail_system(file_, "look at the locks of", errno);
  return range.l_type != F_UNLCK;
}

}  // namespace ds
