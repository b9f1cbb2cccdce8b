// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/database.h"

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

void remove_product(Database& database, Hash128 key);
/// With all that stands of it: images, placed files, builds.
void remove_dataset(Database& database, const std::string& id);

}  // namespace ds
