// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/log.h"

#include <fmt/format.h>

#include <cstdio>

namespace ds {

void warn(std::string_view message) {
  const std::string line = fmt::format("dsbuild: warning: {}\n", message);
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace ds
