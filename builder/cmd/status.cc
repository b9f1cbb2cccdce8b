// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/plan_text.h"
#include "builder/cmd/progress.h"
#include "builder/cmd/slurm_state.h"
#include "builder/cmd/verbs.h"
#include "builder/plan/plan.h"
#include "builder/store/build_ending.h"
#include "tracer/base/shell_quoted.h"
#include "tracer/base/streams.h"

#include <algorithm>
#include <optional>

namespace ds {

namespace {

/// A folder that was moved is not looked for.
std::string why_never(const Dataset& dataset) {
  if (has_lost_state(dataset.folder))
    return "unknown: a manifest lies there without its .dsbuild, which belongs to it";
  return fmt::format("never in this folder; if it was moved: dsbuild status {} -o FOLDER",
                     dataset.recipe.file.string());
}

std::uint64_t not_reached(const BuildRow& build) {
  return build.images - std::min(build.images, build.built + build.reused + build.failed);
}

bool is_under_way(const BuildRow& build) {
  return build.outcome == "running";
}

/// How the build ended, and what it left undone. One that runs or was killed took down no numbers: what is
/// there is told instead.
std::string ending_text(const BuildRow& build, const PlanCounts& counts) {
  if (is_under_way(build) || build.outcome == "killed")
    return fmt::format("{}, {} of {} images are made",
                       is_under_way(build) ? "running" : "killed before its end",
                       counts.up_to_date + counts.place, counts.images);
  std::string text = build.outcome;
  if (build.outcome == k_disk_failed) text += " (full, read only or broken)";
  text += fmt::format(", {} built", build.built);
  if (build.failed > 0) text += fmt::format(", {} failed", build.failed);
  if (not_reached(build) > 0) text += fmt::format(", {} not reached", not_reached(build));
  return text + ", " + format_duration(build.seconds);
}

nlohmann::json ending_json(const BuildRow& build) {
  return {
      {"outcome", build.outcome}, {"started_at", build.started_at},    {"built", build.built},
      {"failed", build.failed},   {"not_reached", not_reached(build)}, {"seconds", build.seconds}};
}

/// A folder that was built with other --set than these, which may be why so much is stale.
std::string built_otherwise(const Dataset& dataset, const PlanCounts& counts) {
  const std::optional<DatasetRow> built = dataset.database->find_dataset(dataset.row.id);
  if (counts.stale == 0 || !built || built->overrides == dataset.row.overrides) return "";
  std::string settings;
  for (const std::string& assignment : built->overrides)
    settings += " --set " + shell_quoted(assignment);
  return fmt::format("built with{}: dsbuild status {} looks at it with {}",
                     settings.empty() ? " no --set" : settings, dataset.folder.string(),
                     settings.empty() ? "none" : "these");
}

/// A build that is under way writes the manifest at its end.
void print_manifest(const Plan& plan, const std::optional<BuildRow>& last) {
  if (last && is_under_way(*last) && !plan.manifest.current())
    say(Stream::result, "manifest is written at the build's end\n");
  else
    print_manifest_line(plan);
}

}  // namespace

int run_status(const Arguments& arguments) {
  const Shard shard = shard_of(arguments);
  RealDisk disk;
  Dataset dataset = open_dataset(arguments.request(), Access::look, disk);
  Inputs inputs(*dataset.database, stamps_of(arguments));
  const Plan plan = make_plan(dataset, inputs, false, shard);
  const PlanCounts counts = count(plan);
  const std::vector<BuildRow> builds = dataset.database->builds(dataset.row.id);
  std::optional<BuildRow> last;
  if (!builds.empty()) last = as_ended(dataset, builds.front());
  const std::optional<SlurmMark> mark =
      dataset.store ? find_slurm_mark(*dataset.store) : std::nullopt;
  const std::string store = dataset.store ? dataset.store->folder().string() : "";
  if (arguments.json) {
    nlohmann::json object = to_json(counts);
    object["manifest"] = to_json(plan.manifest);
    object["name"] = dataset.recipe.name;
    object["recipe"] = dataset.recipe.file.string();
    object["folder"] = dataset.folder.string();
    object["store"] = store;
    object["builds"] = builds.size();
    object["last_build"] = last ? ending_json(*last) : nlohmann::json();
    object["slurm"] = mark ? to_json(*mark) : nlohmann::json();
    object["kept"] = counts.up_to_date + counts.place;
    print_json(object);
    return counts.failed > 0 ? 1 : 0;
  }
  say(Stream::result, "dataset  {}\nrecipe   {}\nfolder   {}\n", dataset.recipe.name,
      dataset.recipe.file.string(), dataset.folder.string());
  if (!store.empty()) say(Stream::result, "store    {}\n", store);
  if (last)
    say(Stream::result, "build    {} UTC, {}\n", last->started_at, ending_text(*last, counts));
  else
    say(Stream::result, "build    {}\n", why_never(dataset));
  if (mark)
    say(Stream::result, "slurm    {}; {} of {} images are kept\n", to_text(*mark),
        counts.up_to_date + counts.place, counts.images);
  say(Stream::result, "{}\n", summary(counts));
  if (const std::string why = built_otherwise(dataset, counts); !why.empty())
    say(Stream::result, "{}\n", why);
  print_manifest(plan, last);
  return counts.failed > 0 ? 1 : 0;
}

}  // namespace ds
