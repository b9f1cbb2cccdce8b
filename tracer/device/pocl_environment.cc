// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/pocl_environment.h"

#include "tracer/base/error.h"
#include "tracer/base/process_folder.h"
#include "tracer/device/program_cache.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <string_view>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace ds {
namespace {

void set_unless_set(const char* name, const std::string& value) {
  if (::setenv(name, value.c_str(), 0) != 0)
    fail(ErrorKind::io, "cannot set {}: {}", name, std::strerror(errno));
}

/// PoCL offers no device, without a word why, where it cannot write into its cache.
void check_cache_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder, error))
    error = std::make_error_code(std::errc::not_a_directory);
  if (!error && ::access(folder.c_str(), R_OK | W_OK | X_OK) != 0)
    error = {errno, std::generic_category()};
  if (error)
    fail(ErrorKind::device, "POCL_CACHE_DIR = {} cannot be used: {}", folder.string(),
         error.message());
}

}  // namespace

void prepare_pocl_environment() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (const char* const given = std::getenv("POCL_CACHE_DIR"))
      check_cache_folder(given);
    else
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
