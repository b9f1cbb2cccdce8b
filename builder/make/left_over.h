// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/plan.h"
#include "builder/store/dataset.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace ds {

struct RemovedFiles {
  std::uint64_t files = 0;
  std::vector<std::pair<std::string, std::string>> failures;  ///< path, why it stays
};

/// Removes the plan's `to_remove` with the folders that leaves empty, and what the database has of
/// images that the recipe does not. A file that cannot be removed stays, and is tried again by the
/// next build. Throws DiskFailed.
RemovedFiles remove_left_over(Dataset& dataset, const Plan& plan, Disk& disk);

}  // namespace ds
