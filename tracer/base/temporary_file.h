// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <fcntl.h>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace ds {

/// Throws Error(io), or DiskFailed, with what errno says.
[[noreturn]] void fail_errno(const std::filesystem::path& path, const char* what);

/// An open file descriptor that closes itself; `close` reports what the destructor has to swallow.
class Descriptor {
 public:
  /// Errors are told of `path`.
  Descriptor(const std::filesystem::path& path, int flags) : Descriptor(path, flags, path) {}
  /// Errors are told of `name`.
  Descriptor(const std::filesystem::path& path, int flags, const std::filesystem::path& name);
  /// Takes over what ::open gave for `path`; -1: throws what errno says.
  Descriptor(int opened, const std::filesystem::path& path);
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor();
  int get() const { return fd_; }
  /// Writes all of it.
  void write(std::span<const std::byte> bytes) const;
  /// Bytes read, as many as there are up to so many; 0 at the end.
  std::size_t read(std::span<char> bytes) const;
  void sync() const;
  void close();

 private:
  std::filesystem::path path_;
  int fd_;
};

/// How a temporary is opened: as names are made, two writers could still have one; then this one
/// fails.
inline constexpr int k_write_new = O_WRONLY | O_CREAT | O_EXCL;

/// A name beside `target` that no other file has. Removes the file of that name unless it was
/// renamed.
class TemporaryName {
 public:
  explicit TemporaryName(const std::filesystem::path& target);
  TemporaryName(TemporaryName&& other) noexcept;
  TemporaryName& operator=(TemporaryName&&) = delete;
  ~TemporaryName();
  const std::filesystem::path& path() const { return path_; }
  /// The folder is not synced.
  void rename_to(const std::filesystem::path& target);

 private:
  std::filesystem::path path_;
  bool renamed_ = false;
};

/// The process that made a temporary of that name, in whatever folder; nothing for other names. Older
/// ones began with the target's name: ".NAME.PROCESS.COUNT.tmp".
std::optional<std::int64_t> process_of_temporary(std::string_view name);

/// A target with a parent folder, which exists.
std::filesystem::path prepare_target(const std::filesystem::path& path);

}  // namespace ds
