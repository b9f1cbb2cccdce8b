// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/database.h"
#include "builder/store/store.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ds {

/// A build that puts files into a store now, or did when it was killed on another machine.
struct RunningBuild {
  std::string who;  ///< "process 17 on host, which builds tiny"
  /// What it made was written later.
  std::filesystem::file_time_type since;
};

/// Of the store's own database, and guests (guest.h). Those of this machine that were killed are not
/// among them. Throws Error(io).
std::vector<RunningBuild> running_builds(const Store& store, Database& database);

}  // namespace ds
