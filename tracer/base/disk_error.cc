// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/disk_error.h"

#include <cerrno>
#include <system_error>

namespace ds {

void fail_system(const std::filesystem::path& path, std::string_view what, int error) {
  const std::string message =
      fmt::format("{}: cannot {}: {}", path.string(), what, std::generic_category().message(error));
  for (const int of_disk : {ENOSPC, EDQUOT, EROFS, EIO})
    if (error == of_disk) throw DiskFailed(message);
  throw Error(ErrorKind::io, message);
}

}  // namespace ds
