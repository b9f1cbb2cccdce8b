// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/database.h"
#include "builder/store/claims.h"
#include "builder/store/store.h"

#include <filesystem>
#include <memory>
#include <string_view>

namespace ds {

/// Opens or makes the store's database. A damaged one is set aside as "dsbuild.sqlite.damaged" with
/// a warning, and a new one is filled from the records that stand beside the objects: nothing is
/// traced again for it. Datasets and build logs are lost with it; the next build of a recipe enters
/// its dataset anew. Throws Error(io) where it is damaged and another process has it open.
std::unique_ptr<Database> open_database(Store& store, Claims& claims);

/// The same for whoever owns it (Claims::try_own_database) and takes things away: throws DamagedDatabase
/// where it is damaged.
std::unique_ptr<Database> open_own_database(Store& store);

/// Opens a copy of the store's database, as whoever may not write there wants it: SQLite has to write
/// beside a database to read it. `with_records`: with what the store's records tell of since. What is
/// written to the copy is lost. Throws Error(io).
std::unique_ptr<Database> open_database_copy(Store& store, bool with_records = false);

/// Opens or makes the store's database in a folder of this machine's own, for a store on a file system
/// where several machines write and no database should be: a copy of what the store has of one, and
/// what its records tell of. `claims` are of that folder. As open_database where it is damaged.
std::unique_ptr<Database> open_local_database(Store& store, Claims& claims,
                                              const std::filesystem::path& folder);

/// Enters what a record's text tells of and the database does not know. Throws UnreadableRecord.
void enter_record(Database& database, const std::string& text);

/// Puts a whole copy of a database that lies elsewhere in the place of the store's own, which nobody
/// has open. Throws Error(io).
void put_database(const Store& store, Database& database, const std::filesystem::path& folder,
                  Disk& disk);

/// Whether this process may not write into the folder: it is another user's, or its disk is mounted
/// read-only.
bool is_read_only(const std::filesystem::path& folder);
/// Where a database for a store that may not be written to lies, of builds that take from it what
/// it has: in the dataset's own `state` folder. Empty where the store may be written to, or is that
/// folder; and, unless it `may_make` one, where none is there.
std::filesystem::path database_beside(const std::filesystem::path& store,
                                      const std::filesystem::path& state, bool may_make);
/// Throws Error(io), with what to do, where a store may not be written to. `why`: what would be: "a
/// build keeps there what it makes".
void refuse_read_only(const std::filesystem::path& folder, std::string_view why);

}  // namespace ds
