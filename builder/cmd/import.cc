// SPDX-License-Identifier: Apache-2.0
#include "builder/import/import.h"

#include "builder/cmd/plan_text.h"
#include "builder/cmd/stop_signal.h"
#include "builder/cmd/verbs.h"
#include "builder/cmd/work_progress.h"
#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/base/streams.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Named in full; what follows is counted.
constexpr std::size_t k_shown = 5;

/// DIR, or psb DIR: the benchmark needs no other reading than any folder with class files.
fs::path source_of(const Arguments& arguments) {
  if (arguments.import_psb.empty()) return arguments.import_from;
  if (arguments.import_from == "psb") return arguments.import_psb;
  fail(ErrorKind::usage, "import: wanted DIR or psb DIR, got {} {}", arguments.import_from,
       arguments.import_psb);
}

fs::path folder_of(const Arguments& arguments, const fs::path& source) {
  if (!arguments.import_folder.empty()) return arguments.import_folder;
  const fs::path whole = fs::absolute(source).lexically_normal();
  return (whole.filename().empty() ? whole.parent_path() : whole).filename().string() + "-dataset";
}

void print_some(const char* what, const std::vector<std::string>& names) {
  if (names.empty()) return;
  const auto shown = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), k_shown));
  say(Stream::result, "{} {}: {}{}\n", names.size(), what, fmt::join(names.begin(), shown, ", "),
      names.size() > k_shown ? fmt::format(" and {} more", names.size() - k_shown) : "");
}

void print_broken(const ImportResult& result) {
  for (std::size_t i = 0; i < std::min(result.broken.size(), k_shown); ++i)
    say(Stream::result, "left out {}: {}\n", result.broken[i].first, result.broken[i].second);
  if (result.broken.size() > k_shown)
    say(Stream::result, "left out {} more that cannot be used (--json names all)\n",
        result.broken.size() - k_shown);
}

/// What folders said of splits, which may not be what they are for.
void print_folders(const ImportResult& result) {
  std::string told;
  for (const auto& [folder, split] : result.split_folders)
    told += fmt::format("{}{}{}", told.empty() ? "" : ", ", folder,
                        folder == split ? "" : fmt::format(" ({})", split));
  if (!told.empty())
    say(Stream::result,
        "splits are from the folders {} (--no-split-folders takes them for classes)\n", told);
  if (!result.class_folders.empty())
    say(Stream::result,
        "taken for classes, though called as splits are: {} (the column split of classes.csv says "
        "what is which)\n",
        fmt::join(result.class_folders, ", "));
}

/// What an update found beside what is new.
void print_update(const ImportResult& result) {
  if (!result.updated) return;
  print_some("listed, without a file any more; their lines stay", result.gone);
  print_some("left out as before, since their lines were taken out of classes.csv",
             result.taken_out);
  print_some("new ones without a split, which others have in classes.csv", result.unsplit);
  print_some("new classes", result.new_classes);
}

/// "recipe.toml: 12 models of 3 classes, 3 test, 9 train"
std::string summary_of(const ImportResult& result) {
  std::string splits;
  for (const auto& [split, count] : result.splits)
    if (!split.empty()) splits += fmt::format(", {} {}", count, split);
  return fmt::format("{}: {} {}model{} of {} class{}{}{}", result.recipe.string(), result.models,
                     result.updated ? "new " : "", result.models == 1 ? "" : "s",
                     result.classes.size(), result.classes.size() == 1 ? "" : "es", splits,
                     result.updated ? fmt::format(" beside {}", result.kept) : "");
}

nlohmann::json to_json(const ImportResult& result) {
  nlohmann::json broken = nlohmann::json::array();
  for (const auto& [model, why] : result.broken)
    broken.push_back({{"model", model}, {"error", why}});
  nlohmann::json own_broken = nlohmann::json::array();
  for (const auto& [model, why] : result.own_broken)
    own_broken.push_back({{"model", model}, {"error", why}});
  nlohmann::json json{{"recipe", result.recipe.string()},
                      {"models", result.models},
                      {"splits", result.splits},
                      {"classes", result.classes},
                      {"classes_of_one_model", result.single},
                      {"hierarchies", result.hierarchies},
                      {"broken", broken},
                      {"mended", result.mended},
                      {"missing", result.missing},
                      {"unclassified", result.unclassified},
                      {"split_folders", result.split_folders},
                      {"class_folders", result.class_folders},
                      {"own_materials", result.own},
                      {"own_materials_broken", own_broken}};
  if (result.updated)
    json.update({{"kept", result.kept},
                 {"new_classes", result.new_classes},
                 {"taken_out", result.taken_out},
                 {"gone", result.gone},
                 {"unsplit", result.unsplit}});
  return json;
}

/// A folder for each model, as ShapeNet has them, is hardly a class of its own.
void warn_of_single(const ImportResult& result, const Arguments& arguments) {
  const auto nested =
      std::count_if(result.single.begin(), result.single.end(),
                    [](const std::string& path) { return path.find('/') != std::string::npos; });
  if (nested == 0) return;
  const bool first_helps = arguments.import_classes != "folder";
  warn(fmt::format("{} of {} classes have one model, as {}{}", result.single.size(),
                   result.classes.size(), result.single.front(),
                   first_helps
                       ? ": all folders that a model lies in are its class; with --classes folder "
                         "the first of them is"
                       : ""));
}

}  // namespace

int run_import(const Arguments& arguments) {
  const fs::path source = source_of(arguments);
  const ImportRequest request{source,
                              folder_of(arguments, source),
                              arguments.copy,
                              arguments.import_classes,
                              !arguments.no_split_folders,
                              arguments.update};
  const std::atomic<bool>& stop = stop_on_signal();
  ImportResult result;
  {
    WorkProgress progress("models read");
    result = import_models(
        request, [&](std::uint64_t done, std::uint64_t all) { progress(done, all); }, stop);
  }
  warn_of_single(result, arguments);
  if (arguments.json) {
    print_json(to_json(result));
    return 0;
  }
  print_broken(result);
  print_some("mended (dsbuild models tells what)", result.mended);
  print_some("in class files, without a file here", result.missing);
  print_some("without a class", result.unclassified);
  print_some("with materials of their own (materials.assign = \"own\" shows them)", result.own);
  for (std::size_t i = 0; i < std::min(result.own_broken.size(), k_shown); ++i)
    say(Stream::result, "own materials of {} cannot be shown: {}\n", result.own_broken[i].first,
        result.own_broken[i].second);
  print_folders(result);
  print_update(result);
  say(Stream::report, "{}\n", summary_of(result));
  return 0;
}

}  // namespace ds
