// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/dataset.h"
#include "builder/upkeep/running_builds.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ds {

/// Files and bytes.
struct Amount {
  std::uint64_t files = 0, bytes = 0;
  void add(std::uint64_t more) {
    ++files;
    bytes += more;
  }
};

struct DatasetUse {
  DatasetRow row;
  std::filesystem::path
      folder;            ///< where its last build left it; empty where an older dsbuild made it
  bool is_gone = false;  ///< nothing of it lies there any more
  std::uint64_t images = 0;
};

/// An object or a record of a store, and whether a dataset names it: one of its files is placed from
/// it, it is the film of one of its images, or it was made together with one of these.
struct StoreFileUse {
  Store::Kind kind = Store::Kind::object;
  Hash128 hash;
  std::uint64_t bytes = 0;
  std::filesystem::file_time_type written;
  bool is_named = false;
  bool is_being_made =
      false;  ///< not named, and written since the first of the builds began that run
};

/// A record that a dataset names, with products that none does.
struct PartlyNamed {
  Hash128 record;
  std::vector<Hash128> unnamed;  ///< keys of products
};

struct StoreUse {
  std::vector<DatasetUse> datasets;
  /// Folders of datasets of this store that its database does not know.
  std::vector<std::filesystem::path> unknown;
  std::vector<StoreFileUse> files;
  std::vector<std::string> faults;  ///< a line for each damaged record, and for what is no file
  std::uint64_t unreadable = 0;     ///< records of another form: they and what they name stay
  std::vector<std::filesystem::path> strangers;    ///< files that are not the store's: left alone
  std::vector<std::filesystem::path> temporaries;  ///< of killed writers
  std::uint64_t temporary_bytes = 0;
  Amount temporaries_now;  ///< of processes that run on this machine: none of those above
  std::vector<PartlyNamed> partly_named;
  std::uint64_t database_bytes = 0;       ///< of its file and its log
  std::uint64_t database_free = 0;        ///< of those, what holds nothing
  std::map<std::string, Amount> by_kind;  ///< named objects by what they are: "image", "film"
  std::uint64_t missing = 0;              ///< objects that a dataset names and that are not there
  std::vector<Hash128> unnamed_products;  ///< keys, of the database
};

/// `forget_gone`: as if datasets whose folder is gone named nothing. `running`: who may put files there
/// meanwhile. Reads the database and every record, not the objects, and leaves all as it is. Throws
/// Error(cancelled) where `stop` is set.
StoreUse look_at_store(const Store& store, Database& database, bool forget_gone,
                       const std::vector<RunningBuild>& running, const std::atomic<bool>& stop);

}  // namespace ds
