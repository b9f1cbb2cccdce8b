// SPDX-License-Identifier: Apache-2.0
#include "builder/make/sole_plan.h"

#include "builder/plan/manifest_state.h"
#include "builder/store/host.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>
#include <unistd.h>

namespace ds {
namespace {

/// How often a build that waits looks whether it may go on.
constexpr std::chrono::milliseconds k_poll{100};

std::string who_builds(const Dataset& dataset) {
  std::string text =
      fmt::format("process {} on {}, {}", ::getpid(), host_name(), dataset.recipe.file.string());
  for (const std::string& assignment : dataset.row.overrides)
    text += " --set " + assignment;
  return text;
}

}  // namespace

SolePlan make_sole_plan(Dataset& dataset, Stamps stamps, bool force, Shard shard, Wanted wanted,
                        const std::function<void(const std::string& who)>& waits_for) {
  SolePlan sole;
  sole.lock = std::make_unique<FolderLock>(dataset.lock_folder);
  const auto plan = [&] {
    sole.inputs = std::make_unique<Inputs>(*dataset.database, stamps);
    sole.plan = make_plan(dataset, *sole.inputs, force, shard, wanted);
    return what_is_made(sole.plan);
  };
  std::string told;
  for (;;) {
    const std::int64_t version = dataset.database->data_version();
    const Hash128 what = plan();
    bool waited = false;
    while (const auto other = sole.lock->try_join(what, who_builds(dataset))) {
      if (*other != told) waits_for(*other);
      told = *other;
      waited = true;
      std::this_thread::sleep_for(k_poll);
    }
    // What others did since this was planned is not in the plan; from now on only those who make
    // the same do anything.
    if (!waited && version == dataset.database->data_version()) return sole;
    if (plan() == what) return sole;
    sole.lock->leave();  // a file was edited meanwhile
  }
}

}  // namespace ds
