// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/store.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// Who fills a store from several machines: text files STORE/slurm/NUMBER, the one of the greatest
/// number holds. A line each:
///   "dsbuild slurm 1"
///   number of shards
///   the recipe, absolute
///   the dataset's folder, absolute
///   when, UTC ("2024-02-29 12:00:00")
///   who: the user, the host and the process there, "anna login1 4711"
///   the jobs' ids, the shards' and the last one's; no such line while they are being submitted
/// Jobs end in many ways, so it says who began, and Slurm says whether that still goes on. Whoever
/// finds it does not makes the next number, which only one can.
struct SlurmMark {
  std::filesystem::path file;
  std::vector<std::string> jobs;
  int shards = 0;
  std::filesystem::path recipe, folder;
  std::string since, user, host;
  std::int64_t process = 0;
};

/// The store's folder of marks; jobs' scripts and logs lie in it, too.
std::filesystem::path slurm_folder(const std::filesystem::path& store);

/// Nothing where nobody fills the store.
std::optional<SlurmMark> find_slurm_mark(const Store& store);

/// Makes the mark after `before`, which goes, and sets `mark.file`. False where another process was
/// quicker. Throws Error(io).
bool make_slurm_mark(const Store& store, const std::optional<SlurmMark>& before, SlurmMark& mark);

/// Adds the jobs to the mark, unless they have ended and taken it away already. Throws Error(io).
void add_jobs(const SlurmMark& mark);

}  // namespace ds
