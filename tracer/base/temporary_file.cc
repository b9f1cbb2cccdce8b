// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/temporary_file.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/files.h"

#include <atomic>
#include <cerrno>
#include <charconv>
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
    : Descriptor(::open(path.c_str(), flags | O_CLOEXEC, 0666), name) {}

Descriptor::Descriptor(int opened, const std::filesystem::path& path) : path_(path), fd_(opened) {
  if (fd_ < 0) fail_errno(path, "open");
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

std::size_t Descriptor::read(std::span<char> bytes) const {
  for (;;) {
    const ssize_t done = ::read(fd_, bytes.data(), bytes.size());
    if (done >= 0) return static_cast<std::size_t>(done);
    if (errno != EINTR) fail_errno(path_, "read");
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

std::optional<std::int64_t> process_of_temporary(std::string_view name) {
  constexpr std::string_view k_ending = ".tmp";
  if (!name.starts_with('.') || !name.ends_with(k_ending)) return std::nullopt;
  name.remove_suffix(k_ending.size());
  const std::size_t count = name.rfind('.');
  if (count == 0 || count == std::string_view::npos) return std::nullopt;
  const std::size_t process = name.rfind('.', count - 1);
  if (process == 0 || process == std::string_view::npos) return std::nullopt;
  const std::string_view digits = name.substr(process + 1, count - process - 1);
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

std::filesystem::path prepare_target(const std::filesystem::path& path) {
  std::filesystem::path target = std::filesystem::absolute(path);
  make_folders(target.parent_path());
  return target;
}

}  // namespace ds
