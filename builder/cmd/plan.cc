// SPDX-License-Identifier: Apache-2.0
#include "builder/build/plan.h"

#include "builder/cmd/plan_text.h"
#include "builder/cmd/verbs.h"

#include <cstdio>

namespace ds {

int run_plan(const Arguments& arguments) {
  RealDisk disk;
  Dataset dataset = open_dataset(arguments.request(), Access::look, disk);
  Inputs inputs(*dataset.database);
  const Plan plan = make_plan(dataset, inputs, false);
  const PlanCounts counts = count(plan);
  if (!arguments.json) {
    print_plan(stdout, plan);
    fmt::print("{}\n", summary(counts));
  } else {
    nlohmann::json object = to_json(counts);
    object["remove_files"] = plan.to_remove;
    object["stale_images"] = nlohmann::json::array();
    object["failed_images"] = nlohmann::json::array();
    for (const PlannedImage& image : plan.images) {
      if (image.error)
        object["failed_images"].push_back({{"id", image.spec.id}, {"why", image.error->what()}});
      if (image.stale())
        object["stale_images"].push_back(
            {{"id", image.spec.id}, {"step", step_of(image)}, {"reasons", image.reasons}});
    }
    print_json(object);
  }
  return counts.failed > 0 ? 1 : 0;
}

}  // namespace ds
