// SPDX-License-Identifier: Apache-2.0
#include "builder/store/disk.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/file_batch.h"
#include "tracer/base/files.h"

#include <system_error>

namespace ds {

void Disk::write_all(std::span<const FileToWrite> files) {
  for (const FileToWrite& one : files)
    write(one.file, one.bytes);
}

void Disk::place_all(std::span<const FileToPlace> files) {
  for (const FileToPlace& one : files) {
    if (one.copy)
      copy(one.from, one.to);
    else
      link(one.from, one.to);
  }
}

void RealDisk::write(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  write_file_atomic(file, bytes);
}

void RealDisk::link(const std::filesystem::path& from, const std::filesystem::path& to) {
  link_file_atomic(from, to);
}

void RealDisk::copy(const std::filesystem::path& from, const std::filesystem::path& to) {
  copy_file_atomic(from, to);
}

void RealDisk::write_all(std::span<const FileToWrite> files) {
  FileBatch batch;
  for (const FileToWrite& one : files)
    batch.write(one.file, one.bytes);
  batch.commit();
}

void RealDisk::place_all(std::span<const FileToPlace> files) {
  FileBatch batch;
  for (const FileToPlace& one : files) {
    if (one.copy)
      batch.copy(one.from, one.to);
    else
      batch.link(one.from, one.to);
  }
  batch.commit();
}

void RealDisk::remove(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error) fail_system(file, "remove", error.value());
}

}  // namespace ds
