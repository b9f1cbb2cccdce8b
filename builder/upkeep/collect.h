// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/upkeep/store_use.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace ds {

/// What `dsbuild store gc` takes away: of what no dataset names, that which is this old, the oldest
/// first, and no more than needed where a size is given.
struct CollectRequest {
  std::chrono::seconds older{0};
  /// What objects, records and database may take in the end.
  std::optional<std::uint64_t> most_bytes;
  bool forget_gone = false;  ///< datasets whose folder is gone, too
  bool dry_run = false;
};

struct CollectResult {
  Amount objects, records, temporaries;  ///< removed, or that would be
  Amount kept;                           ///< objects and records left
  Amount unnamed;                        ///< of those left, what no dataset names
  Amount being_made;                     ///< likewise, and may be of a build that runs
  std::uint64_t forgotten = 0;           ///< datasets
  std::uint64_t products = 0;            ///< rows of the database
  std::uint64_t texts = 0;               ///< likewise
  /// Of records that stay, lines of products that no dataset names and whose objects are gone.
  std::uint64_t lines = 0;
  std::uint64_t database_bytes = 0;  ///< of the database, before; without what holds nothing
  /// Afterwards; nothing for a dry run, since what holds the rows that go holds others, too.
  std::optional<std::uint64_t> database_left;
  std::string
      not_shrunk;  ///< why the database could not be made smaller; "" where nothing was wrong
};

/// The database must be this process's alone (Claims::try_own_database). A kill at any moment leaves
/// a whole store: records go first, then rows, then objects, and the next run finds what is left. Lines go
/// out of records last, by a new record without them before the old one goes. Throws Error(io).
CollectResult collect(Store& store, Database& database, const CollectRequest& request,
                      const StoreUse& use);

}  // namespace ds
