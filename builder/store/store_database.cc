// SPDX-License-Identifier: Apache-2.0
#include "builder/store/store_database.h"

#include "builder/store/made_record.h"
#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/base/process_folder.h"

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>
#include <unistd.h>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_database_file = "dsbuild.sqlite";

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
  const fs::path file = store.folder() / k_database_file;
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

std::unique_ptr<Database> open_own_database(const Store& store) {
  return std::make_unique<Database>(store.folder() / k_database_file);
}

std::unique_ptr<Database> open_database_copy(const Store& store) {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error) / fmt::format("dsbuild-{}", ::getuid());
  const fs::path folder = make_process_folder(parent);
  for (const char* side : {"", "-wal"}) {
    const fs::path name = std::string(k_database_file) + side;
    if (fs::exists(store.folder() / name, error))
      fs::copy_file(store.folder() / name, folder / name, error);
    if (error)
      fail(ErrorKind::io, "{}: cannot copy to {}: {}", (store.folder() / name).string(),
           folder.string(), error.message());
  }
  auto database = std::make_unique<Database>(folder / k_database_file);
  fs::remove_all(folder, error);  // what is open lives on
  return database;
}

bool is_read_only(const fs::path& folder) {
  return ::access(folder.c_str(), W_OK) != 0 && (errno == EROFS || errno == EACCES);
}

}  // namespace ds
