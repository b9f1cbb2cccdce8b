// SPDX-License-Identifier: Apache-2.0
// One process's folder is <process id>-<n>, beside the file <process id>-<n>.lock, on which the
// process holds a flock until it ends, however it ends. Whoever can lock that file may remove both.
#include "tracer/base/process_folder.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Removes the folder of a lock file whose process has ended; leaves one that is still held.
void remove_if_ended(const fs::path& lock_file) {
  const int fd = ::open(lock_file.c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0) return;  // removed by another process just now
  if (::flock(fd, LOCK_EX | LOCK_NB) == 0) {
    std::error_code ignored;  // what cannot be removed now is tried again by the next process
    fs::remove_all(fs::path(lock_file).replace_extension(), ignored);
    ::unlink(lock_file.c_str());
  }
  ::close(fd);
}

void remove_ended(const fs::path& parent) {
  std::error_code ignored;
  std::vector<fs::path> locks;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent, ignored))
    if (entry.path().extension() == ".lock") locks.push_back(entry.path());
  for (const fs::path& lock : locks)
    remove_if_ended(lock);
}

/// Makes and locks a lock file that nobody else has; false where the name is taken or another process
/// removed the folder, empty as it was. The descriptor stays open for the life of the process: that is
/// the lock.
bool take_lock(const fs::path& lock_file) {
  const int fd = ::open(lock_file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd < 0 && (errno == EEXIST || errno == ENOENT)) return false;
  if (fd < 0) fail(ErrorKind::io, "{}: cannot make: {}", lock_file.string(), std::strerror(errno));
  struct stat status {};
  // Between open and flock another process may have taken the file for an ended one's and removed
  // it.
  const bool held =
      ::flock(fd, LOCK_EX | LOCK_NB) == 0 && ::fstat(fd, &status) == 0 && status.st_nlink > 0;
  if (!held) ::close(fd);
  return held;
}

}  // namespace

fs::path make_process_folder(const fs::path& parent) {
  remove_ended(parent);
  for (int n = 0; n < 1000; ++n) {
    make_folders(parent);
    fs::path folder = parent / fmt::format("{}-{}", ::getpid(), n);
    if (!take_lock(folder.string() + ".lock")) continue;
    make_folders(folder);
    return folder;
  }
  fail(ErrorKind::io, "{}: cannot make a folder for this process: every name is taken",
       parent.string());
}

void remove_ended_process_folders(const fs::path& parent) {
  remove_ended(parent);
  std::error_code ignored;
  fs::remove(parent, ignored);  // fails where another process is at work
}

}  // namespace ds
