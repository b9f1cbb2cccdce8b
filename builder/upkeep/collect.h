// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/upkeep/store_use.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>

namespace ds {

/// What `dsbuild store gc` takes away: of what no dataset names, that which is this old, the oldest
/// first, and no more than needed where a size is given.
struct CollectRequest {
  std::chrono::seconds older{0};
  std::optional<std::uint64_t> most_bytes;  ///< what objects and records may take in the end
  bool forget_gone = false;                 ///< datasets whose folder is gone, too
  bool dry_run = false;
};

struct CollectResult {
  Amount objects, records, temporaries;  ///< removed, or that would be
  Amount kept;                           ///< objects and records left
  Amount unnamed;                        ///< of those left, what no dataset names
  std::uint64_t forgotten = 0;           ///< datasets
  std::uint64_t products = 0;            ///< rows of the database
};

/// The database must be this process's alone (Claims::try_own_database). A kill at any moment leaves
/// a whole store: records go first, then rows, then objects, and the next run finds what is left.
/// Throws Error(io).
CollectResult collect(Store& store, Database& database, const CollectRequest& request,
                      const StoreUse& use);

}  // namespace ds
