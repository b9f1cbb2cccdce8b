// SPDX-License-Identifier: Apache-2.0
// A cached program is one file, programs/<key>.bin under the cache folder:
//   "dsbuild program 1\n"          format and version
//   <key, 32 hex digits> "\n"      what it was stored as
//   <XXH3-128 of the rest> "\n"
//   the binary, as the OpenCL driver gave it
// Version 1: first.
#include "tracer/device/program_cache.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_magic = "dsbuild program 1\n";

fs::path program_path(const fs::path& folder, Hash128 key) {
  return folder / "programs" / (key.hex() + ".bin");
}

std::string header(Hash128 key, std::span<const std::byte> binary) {
  return fmt::format("{}{}\n{}\n", k_magic, key.hex(), hash_bytes(binary).hex());
}

/// Whether files can be made in the folder, which is made where it is missing.
bool is_usable(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  return !error && ::access(folder.c_str(), W_OK | X_OK) == 0;
}

/// A name that anybody can guess, in a folder where anybody can make files: taken only if it is
/// ours alone.
fs::path fallback_cache_folder() {
  fs::path folder = fs::temp_directory_path() / fmt::format("dsbuild-{}", ::geteuid());
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    fail(ErrorKind::io,
         "{}: cannot make a cache folder: {}; set XDG_CACHE_HOME to a folder that can be written",
         folder.string(), std::strerror(errno));
  struct stat status {};
  const bool ours = ::lstat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) &&
                    status.st_uid == ::geteuid() && (status.st_mode & 0077) == 0;
  if (!ours)
    fail(
        ErrorKind::io,
        "{}: not used as a cache folder: it is not a folder of this user alone; set XDG_CACHE_HOME",
        folder.string());
  return folder;
}

std::optional<fs::path> user_cache_folder() {
  // The XDG base directory specification: a relative or empty XDG_CACHE_HOME counts as unset.
  const char* xdg = std::getenv("XDG_CACHE_HOME");
  if (xdg != nullptr && fs::path(xdg).is_absolute()) return fs::path(xdg) / "dsbuild";
  const char* home = std::getenv("HOME");
  if (home != nullptr && fs::path(home).is_absolute()) return fs::path(home) / ".cache" / "dsbuild";
  return std::nullopt;
}

}  // namespace

Hash128 program_key(const ProgramIdentity& identity) {
  // Lengths keep the fields apart: none can flow into the next.
  std::string text;
  for (const std::string* field :
       {&identity.source, &identity.options, &identity.platform, &identity.device,
        &identity.device_version, &identity.driver, &identity.environment})
    text += fmt::format("{}:{}\n", field->size(), *field);
  return hash_text(text);
}

fs::path default_cache_folder() {
  const std::optional<fs::path> folder = user_cache_folder();
  return folder && is_usable(*folder) ? *folder : fallback_cache_folder();
}

std::optional<std::vector<std::byte>> load_program(const fs::path& folder, Hash128 key) {
  std::string text;
  try {
    text = read_text_file(program_path(folder, key));
  } catch (const Error&) {
    return std::nullopt;  // absent or unreadable: compiling again is right for both
  }
  const std::size_t header_size = header(key, {}).size();
  if (text.size() <= header_size) return std::nullopt;
  const std::span<const std::byte> binary = bytes_of(text).subspan(header_size);
  if (std::string_view(text).substr(0, header_size) != header(key, binary)) return std::nullopt;
  return std::vector<std::byte>(binary.begin(), binary.end());
}

void store_program(const fs::path& folder, Hash128 key, std::span<const std::byte> binary) {
  std::string text = header(key, binary);
  text.append(reinterpret_cast<const char*>(binary.data()), binary.size());
  write_file_atomic(program_path(folder, key), text);
}

}  // namespace ds
