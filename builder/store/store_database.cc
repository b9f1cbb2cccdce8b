// SPDX-License-Identifier: Apache-2.0
#include "builder/store/store_database.h"

#include "builder/store/made_record.h"
#include "tracer/base/error.h"
#include "tracer/base/log.h"

#include <filesystem>
#include <string>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

void set_aside(const fs::path& file) {
  std::error_code error;
  fs::rename(file, file.string() + ".damaged", error);
  if (error)
    fail(ErrorKind::io, "{}: cannot set the damaged database aside: {}", file.string(),
         error.message());
  // Left in place, SQLite would replay the old log into the new file.
  for (const char* side : {"-wal", "-shm"})
    fs::remove(file.string() + side, error);
}

void refill(Database& database, Store& store) {
  Transaction transaction(database.connection());
  store.visit_records([&](const std::string& text) {
    try {
      for (const MadeProduct& made : from_record(text))
        database.put_product(made.product, made.run);
    } catch (const UnreadableRecord& error) {
      warn(error.what());  // of another version: what it tells of is made again
    }
  });
  transaction.commit();
}

}  // namespace

std::unique_ptr<Database> open_database(Store& store, Claims& claims) {
  const fs::path file = store.folder() / "dsbuild.sqlite";
  claims.share_database();
  std::unique_ptr<Database> database;
  try {
    database = std::make_unique<Database>(file);
  } catch (const DamagedDatabase& error) {
    if (!claims.try_own_database())
      fail(ErrorKind::io, "{}; it cannot be set aside while another dsbuild has it open",
           error.what());
    warn(error.what());
    set_aside(file);
    warn(fmt::format("{0}: set aside as {0}.damaged; its results are taken from the store",
                     file.string()));
    database = std::make_unique<Database>(file);
    claims.share_database();
  }
  // New, set aside, removed or emptied by somebody: the records know what the store holds.
  if (!database->has_products()) refill(*database, store);
  return database;
}

}  // namespace ds
