// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// What another program answered.
struct ProgramAnswer {
  int code = 0;      ///< 128 + its number where a signal ended it
  std::string said;  ///< on its standard output; with `with_errors` also on its standard error
};

/// The first file of that name in a folder of PATH that may be run.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// Runs a program to its end, found by PATH where its name has no slash. Throws Error(io) where it
/// cannot be started.
ProgramAnswer run_program(const std::vector<std::string>& words, bool with_errors = false);

}  // namespace ds
