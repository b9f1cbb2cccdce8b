// SPDX-License-Identifier: Apache-2.0
#include "builder/make/verify.h"

#include "builder/cmd/groups.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/stop_signal.h"
#include "builder/cmd/verbs.h"
#include "builder/store/build_ending.h"
#include "tracer/base/streams.h"

#include <filesystem>

namespace ds {
namespace {

/// A dataset's folder that was copied without its database can be checked for what its manifest
/// says.
bool is_bare_folder(const Arguments& arguments) {
  return std::filesystem::is_directory(arguments.target) && !enclosing_dataset(arguments.target);
}

void verify_dataset(VerifyResult& result, const Arguments& arguments) {
  RealDisk disk;
  Dataset dataset = open_dataset(arguments.request(), Access::look, disk);
  // Bytes are looked at, of outputs and inputs alike: stamps are what the other verbs go by.
  Inputs inputs(*dataset.database, Stamps::ignore);
  const Plan plan = make_plan(dataset, inputs, false);
  verify_against_plan(result, dataset, plan);
  if (arguments.rerender == 0) return;
  TracerOptions options;
  options.device = arguments.device;
  const auto renderer = make_tracer_renderer(inputs, dataset.recipe, options);
  const auto told = [](const std::string& id) { say(Stream::people, "tracing {} again\n", id); };
  verify_by_tracing(result, dataset, plan, inputs, *renderer, arguments.rerender, arguments.seed,
                    told, stop_on_signal());
}

/// How the last build of the folder ended where that was before its end, or it runs still: the
/// manifest may then lag behind what lies there. Empty where it ended as it should, and where
/// nothing is known of it.
std::string unfinished_build(const std::filesystem::path& folder) {
  try {
    RealDisk disk;
    const Dataset dataset =
        open_dataset({.target = folder, .overrides = {}, .output_folder = {}, .store_folder = {}},
                     Access::records, disk);
    const std::vector<BuildRow> builds = dataset.database->builds(dataset.row.id);
    if (builds.empty()) return "";
    const std::string outcome = as_ended(dataset, builds.front()).outcome;
    return outcome == "done" || outcome == "failed" || outcome == "stopped" ? "" : outcome;
  } catch (const Error&) {  // what is to be said of it, the comparison says
    return "";
  }
}

void print_unfinished(const std::string& outcome) {
  if (outcome.empty()) return;
  say(Stream::result, "the last build {}: the manifest may be behind what lies in the folder{}\n",
      outcome == "running"       ? "is still under way"
      : outcome == k_disk_failed ? "was ended by its disk (full, read only or broken)"
                                 : "was " + outcome + " before its end",
      outcome == "running" ? "" : "; dsbuild build goes on");
}

/// Why the folder is not compared with its recipe, where that can be told beforehand.
std::string why_alone(const Arguments& arguments) {
  if (is_bare_folder(arguments)) return "the folder has no .dsbuild that names its recipe";
  const auto recipe = recipe_left_behind(arguments.target);
  if (!recipe) return "";
  return fmt::format(
      "the folder is a copy, or was moved without its recipe {}; name the recipe and "
      "-o {} to compare them",
      recipe->string(), arguments.target);
}

/// Compares a folder with what made it, as far as that is there: for its files, the folder is
/// enough. Returns why it was not compared; empty where it was.
std::string verify_folder(VerifyResult& result, const Arguments& arguments) {
  std::string why = why_alone(arguments);
  if (arguments.rerender > 0) {
    if (!why.empty())
      fail(ErrorKind::usage, "{}: --rerender needs the recipe: {}", arguments.target, why);
    verify_dataset(result, arguments);
    return "";
  }
  if (!why.empty()) return why;
  try {
    verify_dataset(result, arguments);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void print_not_checked(const std::string& why) {
  const std::size_t line_end = why.find('\n');
  say(Stream::result, "not checked: whether it is what its recipe asks for: {}{}\n",
      why.substr(0, line_end), line_end == std::string::npos ? "" : " ...");
}

/// With a file's or an image's own name taken out of what is said of it: "images/a.ply/0.png" and
/// "a.ply/0" are the names of one image.
std::string cause_of(const Finding& finding) {
  return with_replaced(finding.what, finding.path, "*");
}

void print_findings(const VerifyResult& result, bool all, const WholeFolderKind* whole) {
  Groups groups;
  for (const Finding& finding : result.findings) {
    const std::string kind = to_string(finding.kind);
    const std::string line = fmt::format("{}: {}: {}", kind, finding.path, to_text(finding));
    if (all)
      say(Stream::result, "{}\n", line);
    else
      groups.add(cause_of(finding), fmt::format("{}: {}", kind, finding.path), line);
  }
  groups.print(Stream::result, false);
  say(Stream::result, "{}{} files: ", whole ? "" : fmt::format("{} images, ", result.images),
      result.files);
  if (result.rerendered > 0) say(Stream::result, "{} images traced again: ", result.rerendered);
  if (result.findings.empty())
    say(Stream::result, "all as the {}\n",
        whole ? fmt::format("{}'s checksums say", whole->name) : "manifest says");
  else
    say(Stream::result, "{} difference{}\n", result.findings.size(),
        result.findings.size() == 1 ? "" : "s");
}

}  // namespace

int run_verify(const Arguments& arguments) {
  const WholeFolderKind* const whole = whole_folder_kind(arguments.target);
  const std::filesystem::path folder =
      whole ? std::filesystem::path(arguments.target) : dataset_folder(arguments.request());
  const std::string unfinished = whole ? "" : unfinished_build(folder);
  VerifyResult result;
  try {
    result = whole ? verify_whole_folder(folder, *whole) : verify_files(folder);
  } catch (const Error&) {
    print_unfinished(arguments.json ? "" : unfinished);  // why there is no manifest yet
    throw;
  }
  std::string not_checked;
  if (whole)
    not_checked = "";
  else if (!result.has_manifest)
    not_checked = "the manifest cannot be read; the next build writes it anew";
  else if (std::filesystem::is_directory(arguments.target))
    not_checked = verify_folder(result, arguments);
  else
    verify_dataset(result, arguments);
  if (arguments.json) {
    nlohmann::json findings = nlohmann::json::array();
    for (const Finding& finding : result.findings)
      findings.push_back(
          {{"kind", to_string(finding.kind)}, {"path", finding.path}, {"what", to_text(finding)}});
    print_json(
        {{"images", result.images},
         {"files", result.files},
         {"rerendered", result.rerendered},
         {"differences", result.findings.size()},
         {"unfinished_build", unfinished.empty() ? nlohmann::json() : nlohmann::json(unfinished)},
         {"not_checked", not_checked.empty() ? nlohmann::json() : nlohmann::json(not_checked)},
         {"findings", findings}});
  } else {
    print_findings(result, arguments.verbose, whole);
    if (!not_checked.empty()) print_not_checked(not_checked);
    print_unfinished(unfinished);
  }
  return result.findings.empty() ? 0 : 1;
}

}  // namespace ds
