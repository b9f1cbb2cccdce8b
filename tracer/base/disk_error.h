// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace ds {

/// The disk takes nothing more, under whatever name: it is full (or the user's share of it is),
/// read only, or failing. Any other error of a file is that file's own.
class DiskFailed : public Error {
 public:
  explicit DiskFailed(const std::string& message) : Error(ErrorKind::io, message) {}
};

/// Throws DiskFailed or Error(io), as the system's error number says: "PATH: cannot WHAT: reason".
[[noreturn]] void fail_system(const std::filesystem::path& path, std::string_view what, int error);

}  // namespace ds
