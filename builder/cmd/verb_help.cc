// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/command_line.h"
#include "builder/cmd/help_text.h"

#include <fmt/format.h>

namespace ds {
namespace {

constexpr const char* k_footer =
    "DATASET is a recipe (.toml) or the folder an earlier build wrote.\n"
    "Exit codes: 0 all is well; 1 something failed or differs; 2 the command line or the recipe is "
    "wrong.";

/// "-o, --output DIR"; "DATASET".
std::string option_text(const CLI::Option& option) {
  if (option.get_positional())
    return option.get_required() ? option.get_name() : "[" + option.get_name() + "]";
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames())
    names.push_back("-" + name);
  for (const std::string& name : option.get_lnames())
    names.push_back("--" + name);
  std::string text = fmt::format("{}", fmt::join(names, ", "));
  if (option.get_items_expected_min() > 0) text += " " + option.get_type_name();
  return text;
}

std::vector<HelpRow> option_rows(const CLI::App& app, bool positionals) {
  std::vector<HelpRow> rows;
  for (const CLI::Option* option : app.get_options())
    if (option->get_positional() == positionals)
      rows.push_back({option_text(*option), option->get_description()});
  return rows;
}

std::string overview(const CLI::App& app) {
  std::vector<HelpRow> rows;
  for (const Verb& verb : verbs())
    rows.push_back({verb.name, verb.help});
  return fmt::format("{}\n\nUsage: dsbuild [-C DIR] VERB ...\n\n{}\n{}\n{}\n{}\n",
                     app.get_description(), help_rows("Verbs", rows),
                     help_rows("Topics of dsbuild help", topic_rows()),
                     help_rows("Options", option_rows(app, false)),
                     wrap("dsbuild help VERB tells a verb's options. " + std::string(k_footer)));
}

std::string verb_help(const CLI::App& verb) {
  std::string usage = "Usage: dsbuild " + verb.get_name();
  const std::vector<HelpRow> positionals = option_rows(verb, true);
  if (option_rows(verb, false).size() > 1) usage += " [OPTIONS]";
  for (const HelpRow& row : positionals)
    usage += " " + row.name;
  std::string text = fmt::format("{}\n\n{}\n\n", wrap(verb.get_description()), usage);
  if (!positionals.empty()) text += help_rows("Arguments", positionals) + "\n";
  return text + help_rows("Options", option_rows(verb, false)) + "\n" +
         recipe_section_hint(verb.get_name()) + wrap(k_footer) + "\n";
}

}  // namespace

std::string help_of(std::string_view verb) {
  const auto line = make_command_line();
  return verb.empty() ? overview(line->app)
                      : verb_help(*line->app.get_subcommand(std::string(verb)));
}

}  // namespace ds
