// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/cmd/arguments.h"

#include <span>
#include <string>
#include <vector>

namespace ds {

class Disk;

int run_build(const Arguments& arguments);
int run_plan(const Arguments& arguments);
int run_status(const Arguments& arguments);
int run_check(const Arguments& arguments);
int run_classes(const Arguments& arguments);
int run_diff(const Arguments& arguments);
int run_export(const Arguments& arguments);
int run_gallery(const Arguments& arguments);
int run_explain(const Arguments& arguments);
int run_verify(const Arguments& arguments);
int run_models(const Arguments& arguments);
int run_devices(const Arguments& arguments);
int run_accuracy(const Arguments& arguments);
int run_import(const Arguments& arguments);
int run_schema(const Arguments& arguments);
int run_init(const Arguments& arguments);
int run_completions(const Arguments& arguments);
int run_help(const Arguments& arguments);
int run_slurm(const Arguments& arguments);
int run_store(const Arguments& arguments);
int run_clean(const Arguments& arguments);
int run_log(const Arguments& arguments);

/// What `dsbuild store` does.
struct StoreTask {
  const char* name;
  const char* help;
  bool takes_dry_run;
  int (*run)(const Arguments& arguments, Disk& disk);
};
std::span<const StoreTask> store_tasks();

/// What `dsbuild schema` prints.
std::vector<std::string> schema_names();

}  // namespace ds
