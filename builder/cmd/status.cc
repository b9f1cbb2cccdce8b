// SPDX-License-Identifier: Apache-2.0
#include "builder/build/plan.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/progress.h"
#include "builder/cmd/verbs.h"

#include <cstdio>

namespace ds {

int run_status(const Arguments& arguments) {
  RealDisk disk;
  Dataset dataset = open_dataset(arguments.request(), Access::look, disk);
  Inputs inputs(*dataset.database, stamps_of(arguments));
  const PlanCounts counts = count(make_plan(dataset, inputs, false));
  const std::vector<BuildRow> builds = dataset.database->builds(dataset.row.id);
  const std::string store = dataset.store ? dataset.store->folder().string() : "";
  if (arguments.json) {
    nlohmann::json object = to_json(counts);
    object["name"] = dataset.recipe.name;
    object["recipe"] = dataset.recipe.file.string();
    object["folder"] = dataset.folder.string();
    object["store"] = store;
    object["builds"] = builds.size();
    print_json(object);
    return counts.failed > 0 ? 1 : 0;
  }
  fmt::print("dataset  {}\nrecipe   {}\nfolder   {}\n", dataset.recipe.name,
             dataset.recipe.file.string(), dataset.folder.string());
  if (!store.empty()) fmt::print("store    {}\n", store);
  if (builds.empty())
    fmt::print("build    never\n");
  else
    fmt::print("build    {} UTC, {}, {} built, {}\n", builds.front().started_at,
               builds.front().outcome, builds.front().built,
               format_duration(builds.front().seconds));
  fmt::print("{}\n", summary(counts));
  return counts.failed > 0 ? 1 : 0;
}

}  // namespace ds
