// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/plan.h"
#include "builder/store/folder_lock.h"

#include <functional>
#include <memory>
#include <string>

namespace ds {

/// A plan of a folder in which nobody else builds anything else, until this goes.
struct SolePlan {
  std::unique_ptr<FolderLock> lock;
  std::unique_ptr<Inputs> inputs;
  Plan plan;
};

/// Plans, and waits while another build makes something else of the folder: `waits_for` is then
/// told whom for, once for each.
SolePlan make_sole_plan(Dataset& dataset, Stamps stamps, bool force, Shard shard, Wanted wanted,
                        const std::function<void(const std::string& who)>& waits_for);

}  // namespace ds
