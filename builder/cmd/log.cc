// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/plan_text.h"
#include "builder/cmd/progress.h"
#include "builder/cmd/verbs.h"
#include "builder/store/build_ending.h"
#include "builder/store/dataset.h"
#include "tracer/base/streams.h"

namespace ds {

int run_log(const Arguments& arguments) {
  RealDisk disk;
  const Dataset dataset = open_dataset(arguments.request(), Access::records, disk);
  nlohmann::json array = nlohmann::json::array();
  for (const BuildRow& logged : dataset.database->builds(dataset.row.id)) {
    const BuildRow build = as_ended(dataset, logged);
    array.push_back({{"number", build.number},
                     {"started_at", build.started_at},
                     {"host", build.host},
                     {"device", build.device},
                     {"outcome", build.outcome},
                     {"images", build.images},
                     {"built", build.built},
                     {"reused", build.reused},
                     {"failed", build.failed},
                     {"traced_samples", build.traced_samples},
                     {"seconds", build.seconds}});
    if (!arguments.json)
      say(Stream::result,
          "{} UTC  {:<11} {:>6} built {:>6} reused {:>4} failed {:>17} {:>9}  {} {}\n",
          build.started_at, build.outcome, build.built, build.reused, build.failed,
          format_samples(build.traced_samples), format_duration(build.seconds), build.host,
          build.device);
  }
  if (arguments.json) print_json({{"builds", array}});
  return 0;
}

}  // namespace ds
