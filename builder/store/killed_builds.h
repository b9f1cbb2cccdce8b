// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/dataset.h"

#include <cstdint>
#include <filesystem>

namespace ds {

/// Whether there is such a process on this machine that has not ended.
bool is_running(std::int64_t process);

/// Whether a build that the log has as "running" ended without saying so: on this machine, and its
/// process is gone.
bool was_killed(const BuildRow& build);

/// Enters builds of the dataset whose process ended without saying so (kill -9, power cut, full disk)
/// as `as_ended` tells in the log, and removes the half-written temporaries they left in the dataset's folder
/// and the store. `current` is the number of the build that asks. Costs nothing where none was
/// killed.
void clean_up_killed_builds(Dataset& dataset, std::int64_t current);

/// Removes what processes of this machine that have ended left half-written in the folder, and in
/// those below it.
void remove_temporaries(const std::filesystem::path& folder);

}  // namespace ds
