// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/database.h"

#include <cstdint>
#include <functional>
#include <set>
#include <vector>

namespace ds {

/// What all datasets of a store name together, for what looks after the store.
std::vector<DatasetRow> all_datasets(Database& database);
void visit_all_images(
    Database& database,
    const std::function<void(const std::string& dataset, const PartHashes&)>& visit);
void visit_all_placed(
    Database& database,
    const std::function<void(const std::string& dataset, const PlacedView&)>& visit);
/// `kind` holds during the call.
void visit_products(
    Database& database,
    const std::function<void(Hash128 key, std::string_view kind, Hash128 object)>& visit);
/// Builds that the log has as running, with the name of their dataset and the second since 1970 they began.
void visit_running_builds(
    Database& database, const std::function<void(const std::string& dataset, const BuildRow& build,
                                                 std::int64_t unix_seconds)>& visit);

void remove_product(Database& database, Hash128 key);
/// What the database takes on the disk, with its log, and what of that holds nothing: rows that went.
struct DatabaseSize {
  std::uint64_t bytes = 0, free_bytes = 0;
};
DatabaseSize size_of(Database& database);
/// Gives what holds nothing back to the disk. No other process may have the database open. Takes as much again of
/// the disk meanwhile; a kill leaves it as it was. Throws Error(io).
void shrink(Database& database);

/// With all that stands of it: images, placed files, builds.
void remove_dataset(Database& database, const std::string& id);

}  // namespace ds
