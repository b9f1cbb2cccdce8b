// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/cmd/arguments.h"

#include <CLI/CLI.hpp>

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// The command line's words and what they set: shared by the files that make, check and explain it.
struct CommandLine {
  CLI::App app{"dsbuild: datasets of rendered images, built as a program is built", "dsbuild"};
  Arguments arguments;
  std::string folder;  ///< -C
  const Verb* chosen = nullptr;
  /// The values there are, of options and arguments that take one of a few words.
  std::map<const CLI::Option*, std::vector<std::string>> words;
};

/// Every verb and option. It must outlive what is parsed: options set its members.
std::unique_ptr<CommandLine> make_command_line();

/// Declares an option of a verb. A value that it does not take throws Error(usage).
void add_option(CLI::App& verb, Option option, CommandLine& line);

/// Throws Error(usage) for the first word that no verb or option is or takes, in words that help.
/// CLI11 would first miss what is not there because of it, and name a value without saying what was
/// wanted.
void check_words(const CLI::App& app, std::span<const char* const> words);

std::vector<std::string_view> verb_names();

}  // namespace ds
