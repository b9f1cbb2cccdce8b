// SPDX-License-Identifier: Apache-2.0
#include "builder/build/dataset_manifest.h"
#include "builder/cmd/arguments.h"
#include "builder/cmd/help_text.h"
#include "tracer/base/error.h"
#include "tracer/base/nearest.h"
#include "tracer/base/streams.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <system_error>

namespace ds {
namespace {

constexpr const char* k_footer =
    "DATASET is a recipe (.toml) or the folder an earlier build wrote.\n"
    "Exit codes: 0 all is well; 1 something failed or differs; 2 the command line or the recipe is "
    "wrong.";

void add_option(CLI::App& verb, Option option, Arguments& to) {
  switch (option) {
    case Option::target:
      verb.add_option("DATASET", to.target, "recipe, or the folder an earlier build wrote")
          ->required();
      return;
    case Option::optional_target_and_image:
      verb.add_option("DATASET", to.target,
                      "recipe or folder; may be left out where IMAGE is a file of a dataset")
          ->required();
      verb.add_option("IMAGE", to.image, "id (human.ply/0) or file of an image");
      return;
    case Option::topic:
      verb.add_option("TOPIC", to.topic,
                      "a verb, " + fmt::format("{}", fmt::join(help_topics(), ", ")));
      verb.add_option("NAME", to.topic_name, "one type of the topic, or a key of a recipe");
      return;
    case Option::overrides:
      verb.add_option("--set", to.overrides,
                      "key=value: use this in place of the recipe's (repeatable)")
          ->allow_extra_args(false)
          ->type_name("KEY=VALUE");
      return;
    case Option::output_folder:
      verb.add_option("-o,--output", to.output_folder, "the dataset's folder [out/<dataset.name>]")
          ->type_name("DIR");
      return;
    case Option::store_folder:
      verb.add_option("--store", to.store_folder,
                      "store to share between datasets [<output>/.dsbuild]")
          ->type_name("DIR");
      return;
    case Option::device:
      verb.add_option("--device", to.device, "OpenCL device: its number or part of its name")
          ->type_name("NAME");
      return;
    case Option::json:
      verb.add_flag("--json", to.json, "the last line of standard output is one JSON object");
      return;
    case Option::dry_run:
      verb.add_flag("-n,--dry-run", to.dry_run, "only say what would be made");
      return;
    case Option::keep_going:
      verb.add_flag("-k,--keep-going", to.keep_going,
                    "make what can be made where something fails");
      return;
    case Option::force:
      verb.add_flag("--force", to.force, "trace every image again");
      return;
    case Option::rehash:
      verb.add_flag("--rehash", to.rehash,
                    "read every model and output, also where size, times and inode are as before");
      return;
    case Option::adopt:
      verb.add_flag("--adopt", to.adopt,
                    "take the folder over though it belongs to another recipe");
      return;
    case Option::copy:
      verb.add_flag("--copy", to.copy,
                    "make every output a file of its own, which shares nothing with the store");
      return;
    case Option::verbose:
      verb.add_flag("-v,--verbose", to.verbose,
                    "name every image, where else those with one reason share a line");
      return;
    case Option::explain:
      verb.add_flag("--explain", to.explain, "say why each image is made");
      return;
    case Option::strict:
      verb.add_flag(
          "--strict", to.strict,
          "what makes a dataset useless is an error: empty masks, black pictures, classes "
          "without an image, ... (exit code 1; all is made)");
      return;
    case Option::shard:
      verb.add_option("--shard", to.shard,
                      "make only share I of N of the images, chosen by a hash of their names; when "
                      "all N shares are made the dataset is whole [1/1]")
          ->type_name("I/N");
      return;
    case Option::effects:
      verb.add_flag("--effects", to.effects,
                    "list what the image's program simulates and what it leaves out, and why");
      return;
    case Option::rerender:
      verb.add_option("--rerender", to.rerender, "trace N images again and compare their bytes")
          ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 62U))
          ->type_name("N");
      return;
    case Option::report_file:
      verb.add_option("-o,--output", to.report_file,
                      "the report [NAME-accuracy.html]; its numbers go beside it, ending in .csv")
          ->type_name("FILE");
      return;
    case Option::against:
      verb.add_option("--against", to.against, "plot against minutes or spp only [both]")
          ->check(CLI::IsMember({"minutes", "spp"}))
          ->type_name("WHAT");
      return;
    case Option::report_size:
      verb.add_option("--spp", to.most_spp,
                      "most samples a pixel to measure [the recipe's, at least 16]")
          ->check(CLI::Range(4, 1 << 20))
          ->type_name("N");
      verb.add_option("--seeds", to.seeds, "pictures for each error bar [4]")
          ->check(CLI::Range(2, 64))
          ->type_name("N");
      verb.add_flag("--no-choices", to.no_choices, "leave out what settings and effects cost");
      return;
    case Option::forecast:
      verb.add_flag("--time", to.time, "foretell time and disk of what is stale");
      verb.add_option("--error", to.error,
                      "foretell them for this relative error of every picture (0.02)")
          ->check(CLI::Range(1e-6, 1.0))
          ->type_name("X");
      verb.add_option("--budget", to.budget, "say which error this time buys (8h, 90m)")
          ->type_name("TIME");
      verb.add_flag("--recalibrate", to.recalibrate,
                    "measure anew what is foretold from; else once for each program and device");
      return;
    case Option::seed:
      verb.add_option("--seed", to.seed, "chooses the images of --rerender [0]")->type_name("N");
      return;
  }
}

void change_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::current_path(folder, error);
  if (error) fail(ErrorKind::usage, "-C {}: {}", folder, error.message());
}

/// The command line's words and what they set.
struct CommandLine {
  CLI::App app{"dsbuild: datasets of rendered images, built as a program is built", "dsbuild"};
  Arguments arguments;
  std::string folder;
  const Verb* chosen = nullptr;
};

std::unique_ptr<CommandLine> make_command_line() {
  auto line = std::make_unique<CommandLine>();
  CLI::App& app = line->app;
  app.set_version_flag("--version", "dsbuild " + program_version(), "print the version and exit");
  app.set_help_flag("-h,--help", "print this help and exit");
  app.add_option("-C", line->folder, "change to this folder first")->type_name("DIR");
  app.require_subcommand(1);
  app.fallthrough();
  for (const Verb& verb : verbs()) {
    CLI::App* command = app.add_subcommand(verb.name, verb.help);
    for (const Option option : verb.options)
      add_option(*command, option, line->arguments);
    command->callback([chosen = &line->chosen, &verb] { *chosen = &verb; });
  }
  return line;
}

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
  return app.get_options();
}

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
  // CLI11 puts what it checks behind a colon; the help says it in words.
  const std::string value = option.get_type_name();
  if (option.get_items_expected_min() > 0) text += " " + value.substr(0, value.find(':'));
  return text;
}

std::vector<HelpRow> option_rows(const CLI::App& app, bool positionals) {
  std::vector<HelpRow> rows;
  for (const CLI::Option* option : options_of(app))
    if (option->get_positional() == positionals)
      rows.push_back({option_text(*option), option->get_description()});
  return rows;
}

std::string overview(const CLI::App& app) {
  std::vector<HelpRow> rows;
  for (const Verb& verb : verbs())
    rows.push_back({verb.name, verb.help});
  return fmt::format(
             "{}\n\nUsage: dsbuild [-C DIR] VERB ...\n\n{}\n{}\n{}", app.get_description(),
             help_rows("Verbs", rows), help_rows("Options", option_rows(app, false)),
             wrap("dsbuild help VERB tells a verb's options; dsbuild help recipe the keys of "
                  "a recipe; dsbuild help materials, and the like, what a scene's files may "
                  "hold.\n")) +
         wrap(k_footer) + "\n";
}

std::string verb_help(const CLI::App& verb) {
  std::string usage = "Usage: dsbuild " + verb.get_name();
  const std::vector<HelpRow> positionals = option_rows(verb, true);
  if (option_rows(verb, false).size() > 1) usage += " [OPTIONS]";
  for (const HelpRow& row : positionals)
    usage += " " + row.name;
  std::string text = fmt::format("{}\n\n{}\n\n", wrap(verb.get_description()), usage);
  if (!positionals.empty()) text += help_rows("Arguments", positionals) + "\n";
  return text + help_rows("Options", option_rows(verb, false)) + "\n" + wrap(k_footer) + "\n";
}

std::vector<std::string_view> verb_names() {
  std::vector<std::string_view> names;
  for (const Verb& verb : verbs())
    names.emplace_back(verb.name);
  return names;
}

[[noreturn]] void refuse_verb(const std::string& word) {
  std::error_code error;
  if (std::filesystem::exists(word, error))
    fail(ErrorKind::usage, "{} is no verb; to make its images: dsbuild build {}", word, word);
  fail(ErrorKind::usage, "{} is no verb of dsbuild{}", word, known_words(word, verb_names()));
}

/// "; plan has it", "".
std::string verbs_with(const CLI::App& app, const std::string& name) {
  std::vector<std::string> having;
  for (const Verb& verb : verbs())
    if (app.get_subcommand(verb.name)->get_option_no_throw(name) != nullptr)
      having.emplace_back(verb.name);
  if (having.empty()) return "";
  return fmt::format("; {} {} it", fmt::join(having, ", "), having.size() == 1 ? "has" : "have");
}

[[noreturn]] void refuse_option(const CLI::App& app, const CLI::App* verb,
                                const std::string& name) {
  const std::string elsewhere = verbs_with(app, name);
  if (verb == nullptr && !elsewhere.empty())
    fail(ErrorKind::usage, "{} stands before the verb: write dsbuild VERB {}", name, name);
  const std::string owner = verb == nullptr ? "dsbuild" : verb->get_name();
  if (!elsewhere.empty()) fail(ErrorKind::usage, "{} has no option {}{}", owner, name, elsewhere);
  std::vector<std::string> known;
  for (const CLI::App* one : {verb, &app})
    for (const CLI::Option* option :
         one == nullptr ? std::vector<const CLI::Option*>{} : options_of(*one))
      for (const bool is_long : {false, true})
        for (const std::string& word : is_long ? option->get_lnames() : option->get_snames())
          known.push_back((is_long ? "--" : "-") + word);
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  const std::vector<std::string_view> words(known.begin(), known.end());
  fail(ErrorKind::usage, "{} has no option {}{}", owner, name, known_words(name, words));
}

/// Whether the word is an option whose value is the next word. Throws where there is no such
/// option.
bool takes_next_word(const CLI::App& app, const CLI::App* verb, const std::string& word) {
  const auto find = [&](const std::string& name) {
    const CLI::Option* option = verb == nullptr ? nullptr : verb->get_option_no_throw(name);
    if (option == nullptr) option = app.get_option_no_throw(name);
    if (option == nullptr) refuse_option(app, verb, name);
    return option;
  };
  if (word.starts_with("--")) {
    const std::size_t equals = word.find('=');
    return find(word.substr(0, equals))->get_items_expected_min() > 0 && equals == word.npos;
  }
  for (std::size_t i = 1; i < word.size(); ++i)
    if (find({'-', word[i]})->get_items_expected_min() > 0) return i + 1 == word.size();
  return false;
}

/// Throws for a verb or option that nobody knows, in words that help. CLI11 would first miss what
/// is not there because of it.
void check_words(const CLI::App& app, std::span<const char* const> words) {
  const CLI::App* verb = nullptr;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string word = words[i];
    if (word == "--") return;
    if (word.size() > 1 && word[0] == '-' &&
        std::isdigit(static_cast<unsigned char>(word[1])) == 0) {
      if (takes_next_word(app, verb, word)) ++i;
    } else if (verb == nullptr) {
      const std::vector<std::string_view> names = verb_names();
      if (std::find(names.begin(), names.end(), word) == names.end()) refuse_verb(word);
      verb = app.get_subcommand(word);
    }
  }
}

/// CLI11's message about a value, as dsbuild's own begin.
std::string said(const CLI::ParseError& error, const Verb& verb) {
  std::string text = error.what();
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
    return fmt::format(
        "{}: wanted a DATASET: a recipe (.toml), or the folder an earlier build wrote", verb.name);
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const std::size_t colon = text.find(": ");
    return fmt::format("{}: does not know what to do with{}", verb.name, text.substr(colon + 1));
  }
  if (!text.empty() && text[0] >= 'A' && text[0] <= 'Z' && text.size() > 1 && text[1] >= 'a')
    text[0] = static_cast<char>(text[0] - 'A' + 'a');
  return fmt::format("{}: {}", verb.name, text);
}

/// The verb that the words name; check_words has found it to be one. Null where there is none.
const Verb* named_verb(const CLI::App& app, const std::vector<Verb>& table) {
  for (const Verb& verb : table)
    if (app.get_subcommand(verb.name)->parsed()) return &verb;
  return nullptr;
}

}  // namespace

std::string help_of(std::string_view verb) {
  const auto line = make_command_line();
  return verb.empty() ? overview(line->app)
                      : verb_help(*line->app.get_subcommand(std::string(verb)));
}

int run_command_line(std::span<const char* const> words) {
  const auto line = make_command_line();
  CLI::App& app = line->app;
  check_words(app, words);
  try {
    app.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::CallForHelp&) {
    const Verb* verb = named_verb(app, verbs());
    write_text(Stream::result, help_of(verb == nullptr ? "" : verb->name));
    return 0;
  } catch (const CLI::CallForVersion& version) {
    say(Stream::result, "{}\n", version.what());
    return 0;
  } catch (const CLI::ParseError& error) {
    const Verb* verb = named_verb(app, verbs());
    if (verb != nullptr)
      fail(ErrorKind::usage, "{}; see dsbuild help {}", said(error, *verb), verb->name);
    // Nothing was asked for. As git does, but with the code of a wrong command line.
    write_text(Stream::result, help_of(""));
    return exit_code(ErrorKind::usage);
  }
  DS_ASSERT(line->chosen != nullptr);
  if (!line->folder.empty()) change_folder(line->folder);
  return line->chosen->run(line->arguments);
}

}  // namespace ds
