// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/temporary_file.h"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace ds {

/// What stands there in a file's place: "a folder", "a pipe", "a socket", "a device". Nothing for a
/// file, a link to one, and where nothing can be found.
std::optional<std::string> what_is_no_file(const std::filesystem::path& path);

/// Every file that somebody else may have put where it is, is opened by one of these: a pipe or a device
/// could keep who opens or reads it waiting for ever. Throws Error(io), also for what is no file.
Descriptor open_regular(const std::filesystem::path& path);
/// Throws for what is no file; not open where there is none or it cannot be opened.
std::ifstream regular_stream(const std::filesystem::path& path);

}  // namespace ds
