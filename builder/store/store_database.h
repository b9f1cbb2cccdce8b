// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/database.h"
#include "builder/store/claims.h"
#include "builder/store/store.h"

#include <filesystem>
#include <memory>

namespace ds {

/// Opens or makes the store's database. A damaged one is set aside as "dsbuild.sqlite.damaged" with
/// a warning, and a new one is filled from the records that stand beside the objects: nothing is
/// traced again for it. Datasets and build logs are lost with it; the next build of a recipe enters
/// its dataset anew. Throws Error(io) where it is damaged and another process has it open.
std::unique_ptr<Database> open_database(Store& store, Claims& claims);

/// The same for whoever owns it (Claims::try_own_database) and takes things away: throws DamagedDatabase
/// where it is damaged.
std::unique_ptr<Database> open_own_database(const Store& store);

/// Opens a copy of the store's database, as whoever may not write there wants it: SQLite has to write
/// beside a database to read it. What is written to the copy is lost. Throws Error(io).
std::unique_ptr<Database> open_database_copy(const Store& store);

/// Whether this process may not write into the folder: it is another user's, or its disk is mounted
/// read-only.
bool is_read_only(const std::filesystem::path& folder);

}  // namespace ds
