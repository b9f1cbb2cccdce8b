// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/from_manifest.h"

#include "builder/cmd/plan_text.h"
#include "builder/plan/plan.h"
#include "tracer/base/error.h"

namespace ds {

std::string behind_recipe(const Arguments& arguments, const std::string& written) {
  try {
    RealDisk disk;
    Dataset dataset = open_dataset(arguments.request(), Access::look, disk);
    Inputs inputs(*dataset.database, Stamps::trust);
    const Plan plan = make_plan(dataset, inputs, false);
    const PlanCounts counts = count(plan);
    if (counts.stale > 0 || counts.failed > 0)
      return fmt::format(
          "{} of {} images are not as their recipe wants them; {} (dsbuild build first?)",
          counts.stale + counts.failed, counts.images, written);
    return manifest_line(plan.manifest);
  } catch (const Error&) {
    return "";
  }
}

}  // namespace ds
