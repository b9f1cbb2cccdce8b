// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/plan_text.h"
#include "builder/cmd/progress.h"
#include "builder/cmd/verbs.h"
#include "builder/plan/plan.h"
#include "builder/store/killed_builds.h"
#include "tracer/base/streams.h"

namespace ds {

namespace {

/// A folder that was moved is not looked for.
std::string why_never(const Dataset& dataset) {
  if (has_lost_state(dataset.folder))
    return "unknown: a manifest lies there without its .dsbuild, which belongs to it";
  return fmt::format("never in this folder; if it was moved: dsbuild status {} -o FOLDER",
                     dataset.recipe.file.string());
}

}  // namespace

int run_status(const Arguments& arguments) {
  const Shard shard = read_shard(arguments.shard);
  RealDisk disk;
  Dataset dataset = open_dataset(arguments.request(), Access::look, disk);
  Inputs inputs(*dataset.database, stamps_of(arguments));
  const Plan plan = make_plan(dataset, inputs, false, shard);
  const PlanCounts counts = count(plan);
  const std::vector<BuildRow> builds = dataset.database->builds(dataset.row.id);
  const std::string store = dataset.store ? dataset.store->folder().string() : "";
  if (arguments.json) {
    nlohmann::json object = to_json(counts);
    object["manifest"] = to_json(plan.manifest);
    object["name"] = dataset.recipe.name;
    object["recipe"] = dataset.recipe.file.string();
    object["folder"] = dataset.folder.string();
    object["store"] = store;
    object["builds"] = builds.size();
    print_json(object);
    return counts.failed > 0 ? 1 : 0;
  }
  say(Stream::result, "dataset  {}\nrecipe   {}\nfolder   {}\n", dataset.recipe.name,
      dataset.recipe.file.string(), dataset.folder.string());
  if (!store.empty()) say(Stream::result, "store    {}\n", store);
  if (builds.empty())
    say(Stream::result, "build    {}\n", why_never(dataset));
  else
    say(Stream::result, "build    {} UTC, {}, {} built, {}\n", builds.front().started_at,
        was_killed(builds.front()) ? "killed" : builds.front().outcome, builds.front().built,
        format_duration(builds.front().seconds));
  say(Stream::result, "{}\n", summary(counts));
  print_manifest_line(plan);
  return counts.failed > 0 ? 1 : 0;
}

}  // namespace ds
