// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/temporary_file.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/files.h"

#include <atomic>
#include <cerrno>
#include <random>
#include <unistd.h>
#include <utility>

namespace ds {
namespace {

/// Tells the processes of several machines apart that share a folder.
unsigned process_token() {
  static const unsigned token = std::random_device{}();
  return token;
}

}  // namespace

void fail_errno(const std::filesystem::path& path, const char* what) {
  fail_system(path, what, errno);
}

Descriptor::Descriptor(const std::filesystem::path& path, int flags,
                       const std::filesystem::path& name)
    : path_(name), fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
  if (fd_ < 0) fail_errno(name, "open");
}

Descriptor::Descriptor(Descriptor&& other) noexcept
    : path_(std::move(other.path_)), fd_(std::exchange(other.fd_, -1)) {}

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

void Descriptor::write(std::span<const std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t done = ::write(fd_, bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail_errno(path_, "write");
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
}

void Descriptor::sync() const {
  if (::fsync(fd_) != 0) fail_errno(path_, "sync");
}

void Descriptor::close() {
  const int fd = std::exchange(fd_, -1);
  if (::close(fd) != 0) fail_errno(path_, "close");
}

TemporaryName::TemporaryName(const std::filesystem::path& target) {
  // Without the target's name, which may be as long as names can be.
  static std::atomic<unsigned> counter{0};
  path_ = target.parent_path() /
          fmt::format(".{:08x}.{}.{}.tmp", process_token(), ::getpid(), counter.fetch_add(1));
}

TemporaryName::TemporaryName(TemporaryName&& other) noexcept
    : path_(std::move(other.path_)), renamed_(std::exchange(other.renamed_, true)) {}

TemporaryName::~TemporaryName() {
  if (!renamed_) ::unlink(path_.c_str());
}

void TemporaryName::rename_to(const std::filesystem::path& target) {
  if (::rename(path_.c_str(), target.c_str()) != 0)
    fail_errno(target, "rename a finished temporary to");
  renamed_ = true;
}

std::filesystem::path prepare_target(const std::filesystem::path& path) {
  std::filesystem::path target = std::filesystem::absolute(path);
  make_folders(target.parent_path());
  return target;
}

}  // namespace ds
