// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/verbs.h"

namespace ds {

const std::vector<Verb>& verbs() {
  using enum Option;
  static const std::vector<Verb> table{
      {"build",
       "make every image of a recipe that is not there yet",
       {target, overrides, output_folder, store_folder, shard, device, dry_run, keep_going, force,
        rehash, adopt, copy, explain, verbose, strict, json},
       run_build},
      {"plan",
       "list the images a build would make, and why; or forecast its time and disk",
       {target, overrides, output_folder, store_folder, shard, rehash, adopt, forecast, device,
        verbose, json},
       run_plan},
      {"status",
       "say how much of a dataset is up to date",
       {target, overrides, output_folder, store_folder, shard, rehash, json},
       run_status},
      {"explain",
       "say which properties of an image changed, old and new, and what it simulates",
       {optional_target_and_image, overrides, output_folder, store_folder, effects, verbose, json},
       run_explain},
      {"verify",
       "check every file of a dataset, or trace some images again",
       {target, overrides, output_folder, store_folder, rerender, seed, device, verbose, json},
       run_verify},
      {"check",
       "look for what misleads a training: leaks, shortcuts, imbalance, bad masks and pictures",
       {target, overrides, output_folder, only, json},
       run_check},
      {"export",
       "write a dataset in a format that training jobs read",
       {target, overrides, format, export_folder, splits, hierarchy, filters, copy, json},
       run_export},
      {"import",
       "write a recipe for a folder of models, with classes, materials and environments",
       {import_from, import_folder, copy_models, json},
       run_import},
      {"accuracy",
       "measure what accuracy costs in time, and write a report",
       {target, overrides, report_file, against, report_size, device, json},
       run_accuracy},
      {"classes",
       "list the classes of a dataset: ids, models and images of each",
       {target, overrides, output_folder, hierarchy, ids, json},
       run_classes},
      {"models",
       "list what was found and mended in each model",
       {target, overrides, json},
       run_models},
      {"log",
       "list the builds of a dataset: when, where, how long",
       {target, overrides, output_folder, store_folder, json},
       run_log},
      {"devices", "list the OpenCL devices", {json}, run_devices},
      {"help",
       "tell a verb's options, the keys of a recipe or what a scene may hold",
       {topic},
       run_help},
  };
  return table;
}

}  // namespace ds
