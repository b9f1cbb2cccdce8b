// SPDX-License-Identifier: Apache-2.0
#include "builder/store/disk.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/files.h"

#include <system_error>

namespace ds {

void RealDisk::write(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  write_file_atomic(file, bytes);
}

void RealDisk::link(const std::filesystem::path& from, const std::filesystem::path& to) {
  link_file_atomic(from, to);
}

void RealDisk::copy(const std::filesystem::path& from, const std::filesystem::path& to) {
  copy_file_atomic(from, to);
}

void RealDisk::remove(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error) fail_system(file, "remove", error.value());
}

}  // namespace ds
