// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"

#include <filesystem>
#include <system_error>

namespace ds {

/// Relative paths in overrides start from the folder the build was started in.
class WorkingFolder {
 public:
  explicit WorkingFolder(const std::filesystem::path& folder)
      : before_(std::filesystem::current_path()) {
    std::error_code error;
    std::filesystem::current_path(folder, error);
    if (error)
      fail(ErrorKind::io,
           "{}: the folder the dataset was built from, where the paths of its --set start: {}; put "
           "it back, or build the recipe again with -o and --set",
           folder.string(), error.message());
  }
  ~WorkingFolder() {
    std::error_code ignored;
    std::filesystem::current_path(before_, ignored);
  }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

 private:
  std::filesystem::path before_;
};

}  // namespace ds
