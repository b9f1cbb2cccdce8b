// SPDX-License-Identifier: Apache-2.0
#include "builder/build/store_database.h"

#include "builder/build/made_record.h"
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

std::size_t refill(Database& database, Store& store) {
  std::size_t count = 0;
  Transaction transaction(database.connection());
  store.visit_records([&](const std::string& text) {
    for (const MadeProduct& made : from_record(text)) {
      database.put_product(made.product, made.run);
      ++count;
    }
  });
  transaction.commit();
  return count;
}

}  // namespace

std::unique_ptr<Database> open_database(Store& store, Claims& claims) {
  const fs::path file = store.folder() / "dsbuild.sqlite";
  claims.share_database();
  std::string damage;
  try {
    // A store whose database was removed is refilled too.
    if (fs::exists(file)) return std::make_unique<Database>(file);
  } catch (const DamagedDatabase& error) {
    damage = error.what();
  }
  if (!claims.try_own_database()) {
    if (damage.empty()) return std::make_unique<Database>(file);
    fail(ErrorKind::io, "{}; it cannot be set aside while another dsbuild has it open", damage);
  }
  if (!damage.empty()) set_aside(file);
  auto database = std::make_unique<Database>(file);
  const std::size_t count = refill(*database, store);
  if (!damage.empty()) {
    warn(damage);
    warn(fmt::format("{}: set aside as {}.damaged, {} results recovered from the store",
                     file.string(), file.filename().string(), count));
  }
  claims.share_database();
  return database;
}

}  // namespace ds
