// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/command_line.h"

#include "builder/cmd/version.h"
#include "tracer/base/error.h"
#include "tracer/base/streams.h"
#include "tracer/device/opencl.h"

#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

namespace ds {
namespace {

void change_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::current_path(folder, error);
  if (error) fail(ErrorKind::usage, "-C {}: {}", folder, error.message());
}

/// What dsbuild diff takes, in order.
constexpr std::pair<std::string_view, std::string_view> k_of_diff[] = {
    {"A", "a recipe, the folder of a dataset or an image file"},
    {"B", "what A is to be compared with: another dataset, or an image file beside an image file"}};

/// What is left of what CLI11 finds: check_words has found all words to be known.
std::string said(const CLI::ParseError& error, const Verb& verb) {
  const std::string text = error.what();
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    const std::string wanted = text.substr(0, text.find(' '));
    for (const auto& [name, what] : k_of_diff)
      if (wanted == name) return fmt::format("{}: wanted {}, {}", verb.name, wanted, what);
    if (wanted != "DATASET") return fmt::format("{}: wanted {}", verb.name, wanted);
    return fmt::format(
        "{}: wanted a DATASET: a recipe (.toml), or the folder an earlier build wrote", verb.name);
  }
  return fmt::format("{}: {}", verb.name, error.what());
}

/// The verb that the words name; check_words has found it to be one. Null where there is none.
const Verb* named_verb(const CLI::App& app) {
  for (const Verb& verb : verbs())
    if (app.get_subcommand(verb.name)->parsed()) return &verb;
  return nullptr;
}

}  // namespace

std::unique_ptr<CommandLine> make_command_line() {
  auto line = std::make_unique<CommandLine>();
  CLI::App& app = line->app;
  app.set_version_flag("--version", "dsbuild",
                       "print version, commit, processor and OpenCL, and exit");
  app.set_help_flag("-h,--help", "print this help and exit");
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  app.add_option("-C", line->folder, "change to this folder first")->type_name("DIR");
  app.require_subcommand(1);
  app.fallthrough();
  for (const Verb& verb : verbs()) {
    CLI::App* command = app.add_subcommand(verb.name, verb.help);
    for (const Option option : verb.options)
      add_option(*command, option, *line);
    command->callback([chosen = &line->chosen, &verb] { *chosen = &verb; });
  }
  return line;
}

int run_command_line(std::span<const char* const> words) {
  const auto line = make_command_line();
  CLI::App& app = line->app;
  check_words(app, words);
  try {
    app.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::CallForHelp&) {
    const Verb* verb = named_verb(app);
    write_text(Stream::result, help_of(verb == nullptr ? "" : verb->name));
    return 0;
  } catch (const CLI::CallForVersion&) {
    say(Stream::result, "{}\n", version_text());
    return 0;
  } catch (const CLI::ParseError& error) {
    const Verb* verb = named_verb(app);
    if (verb != nullptr)
      fail(ErrorKind::usage, "{}; see dsbuild help {}", said(error, *verb), verb->name);
    // Nothing was asked for. As git does, but with the code of a wrong command line.
    write_text(Stream::result, help_of(""));
    return exit_code(ErrorKind::usage);
  }
  DS_ASSERT(line->chosen != nullptr);
  if (!line->folder.empty()) change_folder(line->folder);
  const Arguments& arguments = line->arguments;
  // Before any work, and not as the fault of the first image that is traced.
  if (!arguments.device.empty()) check_selector(arguments.device);
  return line->chosen->run(arguments);
}

}  // namespace ds
