// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/pocl_environment.h"

#include "tracer/base/error.h"
#include "tracer/base/process_folder.h"
#include "tracer/device/program_cache.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace ds {
namespace {

void set_unless_set(const char* name, const std::string& value) {
  if (::setenv(name, value.c_str(), 0) != 0)
    fail(ErrorKind::io, "cannot set {}: {}", name, std::strerror(errno));
}

}  // namespace

void prepare_pocl_environment() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (std::getenv("POCL_CACHE_DIR") == nullptr)
      set_unless_set("POCL_CACHE_DIR",
                     make_process_folder(default_cache_folder() / "pocl").string());
    set_unless_set("POCL_KERNEL_CACHE", "0");
    set_unless_set("POCL_WORK_GROUP_SPECIALIZATION", "0");
  });
}

std::string pocl_environment() {
  constexpr std::string_view k_harmless[] = {
      "POCL_CACHE_DIR=", "POCL_KERNEL_CACHE=", "POCL_DEBUG=", "POCL_TRACING"};
  std::vector<std::string> lines;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view line = *variable;
    const bool harmless =
        std::any_of(std::begin(k_harmless), std::end(k_harmless),
                    [&](std::string_view prefix) { return line.starts_with(prefix); });
    if (line.starts_with("POCL_") && !harmless) lines.emplace_back(line);
  }
  std::sort(lines.begin(), lines.end());
  std::string text;
  for (const std::string& line : lines)
    text += line + "\n";
  return text;
}

}  // namespace ds
