// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// What Slurm is to make, all paths absolute.
struct SlurmJob {
  std::filesystem::path program;  ///< dsbuild
  std::filesystem::path working_folder, recipe, folder, store;
  std::string name;                         ///< of the dataset
  int shards = 1, nodes = 0;                ///< at once; 0: as many as there are
  std::vector<std::string> settings;        ///< words of every build: --set, --device
  std::vector<std::string> sbatch_options;  ///< as they were given
  std::filesystem::path logs;
  std::filesystem::path mark;  ///< removed at the end; empty: there is none
  /// A store on each node's own disk that takes what shards make until their end; empty: there is
  /// none. "$NAME" in front is a variable of the job's.
  std::string local;
};

/// One bash script: run as it is, as a file or from a pipe, it submits itself, the shards as a job
/// array ("SCRIPT shard") and the job behind them ("SCRIPT last"), and prints both jobs' ids, a
/// line each.
std::string slurm_script(const SlurmJob& job);

}  // namespace ds
