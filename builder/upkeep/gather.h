// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/upkeep/store_use.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace ds {

struct GatherRequest {
  bool move = false;             ///< what the other store has then goes, with what is damaged
  Database* database = nullptr;  ///< of the other store, which is told; null: it keeps none
  std::function<void(std::uint64_t done, std::uint64_t all)> progress;  ///< of records; or empty
};

struct GatherResult {
  Amount objects, records;          ///< taken
  Amount there;                     ///< of either kind, had already
  std::vector<std::string> faults;  ///< a line for each file that is not taken, and why
  std::uint64_t missing = 0;        ///< objects that records name and neither store has
  Amount unrecorded;                ///< objects that no record names: left where they are
};

/// Takes what one store has, and another lacks, into the other: for each record the objects that
/// it names, then the record, then the database's rows. Each file is hashed on the way, stands
/// under its name only once it is whole and on the disk, and is not written where it is, whole: what
/// the other has is read, and taken anew where it is damaged. So it may be killed at any moment and
/// run again, and run beside others that do the same and beside builds of either store. Of a record with objects that are lost the others are taken; what is lost, a
/// build makes again. Throws Error(cancelled) where `stop` is set, and Error(io) where the other
/// store's disk refuses.
GatherResult gather(const Store& from, Store& to, const GatherRequest& request,
                    const std::atomic<bool>& stop);

}  // namespace ds
