// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/command_line.h"
#include "builder/cmd/shell_text.h"
#include "builder/cmd/verbs.h"
#include "manifests/check/check.h"
#include "manifests/export/exporter.h"
#include "tracer/base/error.h"
#include "tracer/base/nearest.h"
#include "tracer/base/number_range.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <system_error>
#include <type_traits>

namespace ds {
namespace {

constexpr NumberRange k_any_count{.least = 0, .most = 1e15};

/// std::uint64_t of std::uint64_t and of std::optional<std::uint64_t>.
template <typename T>
struct Held {
  using type = T;
};
template <typename T>
struct Held<std::optional<T>> {
  using type = T;
};

/// An option whose value is a number: a whole one where `to` is of whole numbers.
template <typename T>
void add_number(CLI::App& verb, const char* name, T& to, NumberRange range, const char* help) {
  using Number = typename Held<T>::type;
  constexpr bool k_whole = std::is_integral_v<Number>;
  const auto read = [&to, name, range, verb = verb.get_name()](const std::string& text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() ||
        !range.contains(static_cast<double>(value)))
      fail(ErrorKind::usage, "{} {}: wanted a {}number {}, got {}", verb, name,
           k_whole ? "whole " : "", range.text(), text.empty() ? "nothing" : text);
    to = value;
  };
  verb.add_option_function<std::string>(name, read, help)->type_name(k_whole ? "N" : "X");
}

/// An option whose value is one of a few words.
void add_word(CommandLine& line, CLI::App& verb, const char* name, std::string& to,
              const std::vector<std::string_view>& known, const char* help) {
  const auto read = [&to, name, known, verb = verb.get_name()](const std::string& text) {
    if (std::find(known.begin(), known.end(), text) == known.end())
      fail(ErrorKind::usage, "{} {}: wanted {}, got {}{}", verb, name,
           fmt::format("{}", fmt::join(known, " or ")), text, did_you_mean(text, known));
    to = text;
  };
  const CLI::Option* option =
      verb.add_option_function<std::string>(name, read, help)->type_name("WHAT");
  line.words[option].assign(known.begin(), known.end());
}

std::vector<std::string> strings_of(const std::vector<std::string_view>& texts) {
  return {texts.begin(), texts.end()};
}

template <typename Rows>
std::vector<std::string> names_of(const Rows& rows) {
  std::vector<std::string> names;
  for (const auto& row : rows)
    names.emplace_back(row.name);
  return names;
}

/// "coco (COCO: annotations ...); csv (...)".
template <typename Rows>
std::string names_and_help(const Rows& rows) {
  std::string text;
  for (const auto& row : rows)
    text += fmt::format("{}{} ({})", text.empty() ? "" : "; ", row.name, row.help);
  return text;
}

}  // namespace

void add_option(CLI::App& verb, Option option, CommandLine& line) {
  Arguments& to = line.arguments;
  switch (option) {
    case Option::target:
      verb.add_option("DATASET", to.target, "recipe, or the folder an earlier build wrote")
          ->required();
      return;
    case Option::two_targets:
      verb.add_option("A", to.target,
                      "recipe or folder of a dataset, of which the manifest is believed (dsbuild "
                      "verify checks that its files are as it says); or an image file")
          ->required();
      verb.add_option("B", to.other, "another; an image file beside an image file")->required();
      return;
    case Option::diff_folder:
      verb.add_option(
              "-o,--output", to.diff_folder,
              "write pictures of the differences there, each with its largest in white; made "
              "whole or not at all")
          ->type_name("DIR");
      return;
    case Option::import_from:
      verb.add_option("DIR", to.import_from,
                      "folder of models, in whatever folders and with whatever class files (.cla); "
                      "or psb, and then the folder of the Princeton Shape Benchmark as published")
          ->required();
      verb.add_option("PSB_DIR", to.import_psb, "behind psb");
      return;
    case Option::import_folder:
      verb.add_option("-o,--output", to.import_folder, "the recipe's folder [DIR's name-dataset]")
          ->type_name("DIR");
      return;
    case Option::import_classes:
      add_word(
          line, verb, "--classes", to.import_classes, {"folder", "folders"},
          "where there are no class files: a model's class is the first folder below DIR that it "
          "lies in, or all of them, as vehicle/car [folders]");
      return;
    case Option::import_update:
      verb.add_flag("--no-split-folders", to.no_split_folders,
                    "folders called train, val, test and the like are classes as any others");
      verb.add_flag("--update", to.update,
                    "add what is new in DIR to what an import wrote, whose files stay as they are: "
                    "lines at the end of classes.csv and ids.txt");
      return;
    case Option::copy_models:
      verb.add_flag("--copy", to.copy, "copy the models beside the recipe, with their licences");
      return;
    case Option::optional_target_and_image:
      verb.add_option("DATASET", to.target,
                      "recipe or folder; may be left out where IMAGE is a file of a dataset")
          ->required();
      verb.add_option("IMAGE", to.image, "id (human.ply/0) or file of an image");
      return;
    case Option::topic: {
      std::vector<std::string>& words = line.words[verb.add_option(
          "TOPIC", to.topic,
          fmt::format("a verb; {}; a section or key of a recipe (camera, camera.fov_deg)",
                      fmt::join(help_topics(), ", ")))];
      words = names_of(verbs());
      for (const std::string_view topic : help_topics())
        words.emplace_back(topic);
      verb.add_option("NAME", to.topic_name,
                      "one type of the topic (materials glass), or a section or key of a recipe");
      return;
    }
    case Option::schema:
      line.words[verb.add_option("WHAT", to.schema,
                                 "recipe; images: a line of manifest/images.jsonl; dataset: "
                                 "manifest/dataset.json")
                     ->required()] = schema_names();
      return;
    case Option::shell_kind:
      line.words[verb.add_option("WHAT", to.shell, "bash, zsh or fish; or man, for man -l")
                     ->required()] = strings_of(shell_texts());
      return;
    case Option::init_from:
      verb.add_option("DIR", to.import_from, "folder of models")->required();
      return;
    case Option::init_file:
      verb.add_option("-o,--output", to.init_file, "the recipe [DIR's name, ending in .toml]")
          ->type_name("FILE");
      return;
    case Option::store_task:
      line.words[verb.add_option("WHAT", to.store_task, names_and_help(store_tasks()))
                     ->required()] = names_of(store_tasks());
      verb.add_option("STORE", to.target, "its folder, or a dataset that it belongs to")
          ->required();
      verb.add_option("TO", to.other,
                      "gather: the store that takes, or a dataset that it belongs to, or a folder "
                      "that is not there yet");
      return;
    case Option::store_limits:
      verb.add_option("--older", to.older,
                      "gc: only what was written longer ago than this (30d, 12h)")
          ->type_name("TIME");
      verb.add_option("--size", to.size,
                      "gc: the oldest first, and only until the store, with its database, takes no "
                      "more than "
                      "this (20G)")
          ->type_name("BYTES");
      verb.add_flag("--forget", to.forget,
                    "gc: also what datasets name whose folder is gone; they are forgotten");
      verb.add_option("--database", to.database_folder,
                      "gather: keep TO's database and locks in this folder of the machine's own, "
                      "where several machines write to TO [TO]")
          ->type_name("DIR");
      return;
    case Option::overrides:
      verb.add_option(
              "--set", to.overrides,
              "use this in place of the recipe's (repeatable; with a recipe only, not with a "
              "folder, which keeps what it was built with)")
          ->allow_extra_args(false)
          ->type_name("KEY=VALUE");
      return;
    case Option::output_folder:
      verb.add_option("-o,--output", to.output_folder,
                      "the dataset's folder [out/<dataset.name>]; with a recipe only")
          ->type_name("DIR");
      return;
    case Option::store_folder:
      verb.add_option("--store", to.store_folder,
                      "store to share between datasets [<output>/.dsbuild]")
          ->type_name("DIR");
      return;
    case Option::database_folder:
      verb.add_option(
              "--database", to.database_folder,
              "keep the store's database and locks in this folder of the machine's own, for a "
              "store where several machines write; a build of all images leaves a whole copy in "
              "the store [the store]")
          ->type_name("DIR");
      return;
    case Option::local_store:
      verb.add_option(
              "--local", to.local_folder,
              "keep what is made in this folder of the machine's own disk, and put it into the "
              "store at the end, however the build ends; wants --database [the store]")
          ->type_name("DIR");
      verb.add_flag("--no-files", to.no_files,
                    "fill the store only: place no file and write no manifest");
      return;
    case Option::slurm_local:
      verb.add_option(
              "--local", to.local_folder,
              "shares keep what they make on their node's own disk, in a folder in this one, and "
              "put "
              "it into the store at their end; may begin with a job's variable ('$TMPDIR') [the "
              "store]")
          ->type_name("DIR");
      return;
    case Option::slurm_jobs:
      add_number(verb, "--nodes", to.nodes, {.least = 1, .most = 65536},
                 "shares that are made at once, each by a job of one node [as many as there are]");
      add_number(verb, "--shards", to.shards, {.least = 1, .most = 65536},
                 "shares of the images, each a job of the array [4 a node, or 8]");
      verb.add_flag(
          "--print", to.print,
          "write the script to standard output, which submits itself where it is run: as a "
          "file, or from a pipe into bash");
      verb.add_option("SBATCH", to.sbatch_options,
                      "options of sbatch for all jobs, behind -- (-- --time=2:00:00 --mem=8G)");
      return;
    case Option::device:
      verb.add_option(
              "--device", to.device,
              "OpenCL device, as dsbuild devices lists them: its number, cpu, gpu or part of "
              "its name [the first GPU, else the CPU]")
          ->type_name("NAME")
          ->envname("DSBUILD_DEVICE");
      return;
    case Option::json:
      verb.add_flag("--json", to.json,
                    "the last line of standard output is one JSON object: the answer, or where "
                    "there is none the error (error, kind, failures with file and line)");
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
    case Option::stall:
      add_number(
          verb, "--stall", to.stall_seconds, {.least = 0, .most = 1e9},
          "seconds without a sign of life (an image begun, ended, or some of its samples "
          "traced; outside of images also any computing) after which what builds is ended, "
          "and the image it was at tried once more, as where the device crashed; at least 5, "
          "more than the longest step takes; 0: never [900]");
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
                    "name every image or property, where else those with one reason share a line");
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
                      "only share I of N of the images, chosen by a hash of their names; when "
                      "all N shares are made the dataset is whole [1/1]")
          ->type_name("I/N");
      return;
    case Option::draws:
      verb.add_flag("--draws", to.draws,
                    "say what the recipe's distributions give: least, greatest and mean, with -v "
                    "each image's");
      break;
    case Option::effects:
      verb.add_flag("--effects", to.effects,
                    "list what the image's program simulates and what it leaves out, and why");
      return;
    case Option::rerender:
      add_number(verb, "--rerender", to.rerender, k_any_count,
                 "trace N images again and compare their bytes");
      return;
    case Option::format:
      line.words[verb.add_option("--format", to.format, names_and_help(exporter_types()))
                     ->required()
                     ->type_name("FORMAT")] = names_of(exporter_types());
      return;
    case Option::export_folder:
      verb.add_option("-o,--output", to.export_folder,
                      "the export's folder, made whole or not at all; an export there is replaced")
          ->required()
          ->type_name("DIR");
      return;
    case Option::partial:
      verb.add_flag(
          "--partial", to.partial,
          "export what is made of a dataset whose recipe wants more images (else an error)");
      return;
    case Option::gallery_folder:
      verb.add_option("-o,--output", to.gallery_folder,
                      "the gallery's folder, made whole or not at all; a gallery there is replaced "
                      "[gallery in the dataset's folder]")
          ->type_name("DIR");
      return;
    case Option::splits:
      verb.add_option("--split", to.splits, "images of this split only (repeatable) [all]")
          ->allow_extra_args(false)
          ->type_name("SPLIT");
      return;
    case Option::hierarchy:
      verb.add_option("--classes", to.hierarchy,
                      "the classes of this one of classes.more, in place of those that images are "
                      "labelled with")
          ->type_name("NAME");
      return;
    case Option::ids:
      verb.add_flag("--ids", to.ids,
                    "only the class paths, by id: as classes.ids reads them, to keep the ids");
      return;
    case Option::filters:
      verb.add_option(
              "--filter", to.filters,
              "images only whose class, model, material, environment, view or fold matches, as "
              "class=vehicle/* (repeatable: of one key any, of several all; * is any text, ? any "
              "character; a class means those below it too, a model its file's stem)")
          ->allow_extra_args(false)
          ->type_name("KEY=PATTERN");
      return;
    case Option::only:
      line.words[verb.add_option("--only", to.only,
                                 "run this check only (repeatable): " + names_and_help(checks()))
                     ->allow_extra_args(false)
                     ->type_name("CHECK")] = names_of(checks());
      return;
    case Option::pictures:
      verb.add_flag("--pictures", to.pictures,
                    "read the files of images, too: near_duplicates, contrast, fireflies of "
                    "pictures, depths of depth and mask");
      return;
    case Option::report_file:
      verb.add_option("-o,--output", to.report_file,
                      "the report [NAME-accuracy.html]; its numbers go beside it, ending in .csv")
          ->type_name("FILE");
      return;
    case Option::against:
      add_word(line, verb, "--against", to.against, {"minutes", "spp"},
               "plot against minutes or spp only [both]");
      return;
    case Option::report_size:
      add_number(verb, "--spp", to.most_spp, {.least = 4, .most = 1 << 20},
                 "most samples a pixel to measure [the recipe's, at least 16]");
      add_number(verb, "--seeds", to.seeds, {.least = 2, .most = 64},
                 "pictures for each error bar [4]");
      verb.add_flag("--no-choices", to.no_choices, "leave out what settings and effects cost");
      return;
    case Option::forecast:
      verb.add_flag("--time", to.time, "forecast time and disk of what is stale");
      add_number(verb, "--error", to.error, {.least = 1e-6, .most = 1},
                 "forecast them for this relative error of every picture (0.02)");
      verb.add_option("--budget", to.budget, "say which error this time buys (8h, 90m)")
          ->type_name("TIME");
      verb.add_flag(
          "--recalibrate", to.recalibrate,
          "measure anew what forecasts are made from; else once for each program and device");
      return;
    case Option::seed:
      add_number(verb, "--seed", to.seed, k_any_count, "chooses the images of --rerender [0]");
      return;
  }
}

}  // namespace ds
