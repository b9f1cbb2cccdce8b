// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace ds {

struct FileToWrite {
  std::filesystem::path file;
  std::span<const std::byte> bytes;
};

struct FileToPlace {
  std::filesystem::path from, to;
  bool copy = false;  ///< as Disk::copy, else as Disk::link
};

/// The file operations a build depends on. Virtual so that a test can fill the disk, tear a file or
/// pull the plug at any one of them.
class Disk {
 public:
  virtual ~Disk() = default;
  /// Replaces the file whole or not at all, and on the disk when it returns. Makes parent folders.
  /// Throws Error(io).
  virtual void write(const std::filesystem::path& file, std::span<const std::byte> bytes) = 0;
  /// `to` becomes the same bytes as `from`, whole or not at all: as link_file_atomic.
  /// Throws Error(io).
  virtual void link(const std::filesystem::path& from, const std::filesystem::path& to) = 0;
  /// The same, as a file of its own.
  virtual void copy(const std::filesystem::path& from, const std::filesystem::path& to) = 0;
  /// The same for several files, in this order where one after the other; where it throws, some may
  /// be the new ones.
  virtual void write_all(std::span<const FileToWrite> files);
  virtual void place_all(std::span<const FileToPlace> files);
  /// No error where there is no such file. Throws Error(io).
  virtual void remove(const std::filesystem::path& file) = 0;
};

/// The machine's own.
class RealDisk : public Disk {
 public:
  void write(const std::filesystem::path& file, std::span<const std::byte> bytes) override;
  void link(const std::filesystem::path& from, const std::filesystem::path& to) override;
  void copy(const std::filesystem::path& from, const std::filesystem::path& to) override;
  /// Waits for the disk as often for many files as for one.
  void write_all(std::span<const FileToWrite> files) override;
  void place_all(std::span<const FileToPlace> files) override;
  void remove(const std::filesystem::path& file) override;
};

}  // namespace ds
