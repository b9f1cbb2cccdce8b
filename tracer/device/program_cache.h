// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/hash.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ds {

/// Everything the machine code of a program depends on.
struct ProgramIdentity {
  std::string source, options;
  std::string platform, device, device_version, driver;
  std::string environment;  ///< settings of the compiler, see `pocl_environment`
};

/// Name of the program in the cache.
Hash128 program_key(const ProgramIdentity& identity);

/// $XDG_CACHE_HOME/dsbuild, or ~/.cache/dsbuild; where neither can be written, dsbuild-<user id> in
/// the folder for temporary files, which must belong to this user alone (what lies in it is run as
/// code). The folder exists when this returns. Throws Error(io) where none can be had.
std::filesystem::path default_cache_folder();

/// The stored binary; nothing where there is none, or where the file is torn, foreign, of another
/// version or of another key (the caller compiles again and stores over it). Safe beside any number
/// of readers and writers in any process.
std::optional<std::vector<std::byte>> load_program(const std::filesystem::path& folder,
                                                   Hash128 key);

/// Stores a binary, whole or not at all. Throws Error(io).
void store_program(const std::filesystem::path& folder, Hash128 key,
                   std::span<const std::byte> binary);

}  // namespace ds
