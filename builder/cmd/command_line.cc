// SPDX-License-Identifier: Apache-2.0
#include "builder/build/dataset_manifest.h"
#include "builder/cmd/arguments.h"
#include "tracer/base/error.h"
#include "tracer/base/streams.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <sstream>
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
          ->type_name("N");
      return;
    case Option::report_file:
      verb.add_option("-o,--output", to.report_file,
                      "the report [NAME-accuracy.html]; its numbers go beside it, ending in .csv")
          ->type_name("FILE");
      return;
    case Option::against:
      verb.add_option("--against", to.against, "plot against minutes or spp only [both]")
          ->check(CLI::IsMember({"minutes", "spp"}));
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

}  // namespace

int run_command_line(std::span<const char* const> command_line) {
  CLI::App app("dsbuild: datasets of rendered images, built as a program is built", "dsbuild");
  Arguments arguments;
  std::string folder;
  app.set_version_flag("--version", "dsbuild " + program_version());
  app.add_option("-C", folder, "change to this folder first")->type_name("DIR");
  app.footer(k_footer);
  app.require_subcommand(1);
  app.fallthrough();
  const Verb* chosen = nullptr;
  for (const Verb& verb : verbs()) {
    CLI::App* command = app.add_subcommand(verb.name, verb.help);
    command->footer(k_footer);
    for (const Option option : verb.options)
      add_option(*command, option, arguments);
    command->callback([&chosen, &verb] { chosen = &verb; });
  }
  try {
    app.parse(static_cast<int>(command_line.size()), command_line.data());
  } catch (const CLI::Success& asked) {  // --help and --version
    std::ostringstream text;
    const int code = app.exit(asked, text, text);
    write_text(Stream::result, text.str());
    return code;
  } catch (const CLI::ParseError& error) {
    fail(ErrorKind::usage, "{}; see dsbuild --help", error.what());
  }
  DS_ASSERT(chosen != nullptr);
  if (!folder.empty()) change_folder(folder);
  return chosen->run(arguments);
}

}  // namespace ds
