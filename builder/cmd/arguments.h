// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/dataset.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// What the command line said. A verb reads what its row of the table names; the rest keeps its
/// default.
struct Arguments {
  std::string target;  ///< recipe or output folder
  std::string other;   ///< what it is compared with
  std::string image;   ///< id of an image, or the path of one of its files
  std::vector<std::string> overrides;
  std::string output_folder, store_folder, device;
  std::string database_folder, local_folder;
  bool no_files = false;
  std::string shard;  ///< empty: all images
  std::uint64_t rerender = 0, seed = 0;
  double stall_seconds = 900;
  std::string format, export_folder, gallery_folder, diff_folder, hierarchy;
  std::string import_from, import_psb, import_folder, import_classes = "folders";
  bool no_split_folders = false, update = false;
  std::vector<std::string> splits, filters, only;
  std::string report_file, against;
  int most_spp = 0, seeds = 4;
  bool no_choices = false;
  bool time = false, recalibrate = false;
  std::optional<double> error;
  std::string budget;
  bool json = false, dry_run = false, keep_going = false, force = false, explain = false,
       strict = false;
  bool effects = false, ids = false, draws = false;
  bool rehash = false;
  bool adopt = false;
  bool copy = false;
  bool partial = false;
  bool pictures = false;
  bool verbose = false;
  std::string shell, init_file;
  std::string store_task, older, size;
  bool forget = false;
  int nodes = 0, shards = 0;  ///< 0: not said
  bool print = false;
  std::vector<std::string> sbatch_options;
  std::string schema;             ///< which one
  std::string topic, topic_name;  ///< of help

  DatasetRequest request() const {
    return {target,
            overrides,
            output_folder,
            store_folder,
            adopt,
            database_folder,
            no_files || (!database_folder.empty() && !shard.empty()),
            local_folder};
  }
};

/// The options a verb can have. Each is declared once, in command_line.cc.
enum class Option {
  target,
  two_targets,
  diff_folder,
  import_from,
  import_folder,
  import_classes,
  import_update,
  copy_models,
  optional_target_and_image,
  topic,
  schema,
  shell_kind,
  init_from,
  init_file,
  store_task,
  store_limits,  ///< what gc takes away, and where gather keeps a database
  local_store,   ///< where a machine keeps what it makes until that is in the store
  slurm_local,   ///< the same, of each node
  overrides,
  output_folder,
  store_folder,
  database_folder,
  device,
  json,
  dry_run,
  keep_going,
  force,
  stall,
  rehash,
  adopt,
  copy,
  verbose,
  explain,
  strict,
  shard,
  draws,
  effects,
  rerender,
  seed,
  format,
  export_folder,
  partial,
  pictures,
  gallery_folder,
  splits,
  hierarchy,
  filters,
  only,
  report_file,
  against,
  report_size,  ///< how much is measured
  ids,
  slurm_jobs,  ///< how many, and their options
  forecast,    ///< what time and disk are forecast for
};

/// A verb of the command. `run` returns the exit code: 0 where all is well, 1 where something
/// failed or differs. It throws Error for the rest.
struct Verb {
  const char* name;
  const char* help;  ///< one line
  std::vector<Option> options;
  int (*run)(const Arguments& arguments);
};

/// In the order `--help` shows them.
const std::vector<Verb>& verbs();

/// What `dsbuild help TOPIC` knows beside the verbs.
std::vector<std::string_view> help_topics();
/// The help of a verb, or of the whole command for "".
std::string help_of(std::string_view verb);

/// Runs the verb that the command line names. Returns the exit code; throws Error.
int run_command_line(std::span<const char* const> words);

}  // namespace ds
