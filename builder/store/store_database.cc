// SPDX-License-Identifier: Apache-2.0
#include "builder/store/store_database.h"

#include "builder/store/guest.h"
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

/// Enters what all records tell of.
void refill(Database& database, Store& store) {
  std::uint64_t unreadable = 0;
  std::string first;
  Transaction transaction(database.connection());
  store.visit_records([&](const std::string& text) {
    try {
      enter_record(database, text);
    } catch (const UnreadableRecord& error) {
      if (++unreadable == 1) first = error.what();
    }
  });
  transaction.commit();
  if (unreadable > 0)
    warn(fmt::format(
        "{}: {} record{} of another dsbuild's form, left as {}; what {} of is made "
        "again where it is wanted ({})",
        store.folder().string(), unreadable, unreadable == 1 ? "" : "s",
        unreadable == 1 ? "it is" : "they are", unreadable == 1 ? "it tells" : "they tell", first));
}

/// A damaged one is set aside.
std::unique_ptr<Database> open_or_renew(const fs::path& file, Claims& claims) {
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
  return database;
}

fs::path taken_filled(const Store& store) {
  return store.folder() / (std::string(k_filled_file) + ".taken");
}

/// Whether builds with databases of their own have been here since the records were last read. Its file
/// has another name until they are: who is killed meanwhile leaves that, and who fills the store
/// meanwhile makes a new one.
bool take_filled(const Store& store) {
  std::error_code error;
  fs::rename(store.folder() / k_filled_file, taken_filled(store), error);
  return !error || fs::exists(taken_filled(store), error);
}

/// Where the database is new, set aside, removed or emptied by somebody, and where others filled
/// the store: the records know what that holds.
void catch_up(Database& database, Store& store) {
  const bool filled = take_filled(store);
  if (filled || !database.has_products()) refill(database, store);
  std::error_code error;
  if (filled) fs::remove(taken_filled(store), error);
}

/// With SQLite's log, of which the last parts may lie there alone.
void copy_database(const Store& store, const fs::path& folder) {
  std::error_code error;
  for (const char* side : {"-wal", ""}) {
    const fs::path name = std::string(k_database_file) + side;
    if (fs::exists(store.folder() / name, error))
      fs::copy_file(store.folder() / name, folder / name, fs::copy_options::overwrite_existing,
                    error);
    if (error)
      fail(ErrorKind::io, "{}: cannot copy to {}: {}", (store.folder() / name).string(),
           folder.string(), error.message());
  }
}

}  // namespace

void enter_record(Database& database, const std::string& text) {
  for (const MadeProduct& made : from_record(text))
    if (!database.find_product(made.product.key)) database.put_product(made.product, made.run);
}

std::unique_ptr<Database> open_database(Store& store, Claims& claims) {
  auto database = open_or_renew(store.folder() / k_database_file, claims);
  catch_up(*database, store);
  return database;
}

std::unique_ptr<Database> open_own_database(Store& store) {
  auto database = std::make_unique<Database>(store.folder() / k_database_file);
  catch_up(*database, store);
  return database;
}

std::unique_ptr<Database> open_database_copy(Store& store, bool with_records) {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error) / fmt::format("dsbuild-{}", ::getuid());
  const fs::path folder = make_process_folder(parent);
  copy_database(store, folder);
  auto database = std::make_unique<Database>(folder / k_database_file);
  if (with_records || fs::exists(store.folder() / k_filled_file, error) ||
      fs::exists(taken_filled(store), error))
    refill(*database, store);
  fs::remove_all(folder, error);  // what is open lives on
  return database;
}

std::unique_ptr<Database> open_local_database(Store& store, Claims& claims,
                                              const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder / k_database_file, error)) copy_database(store, folder);
  auto database = open_or_renew(folder / k_database_file, claims);
  refill(*database, store);  // other machines may have made more
  return database;
}

void put_database(const Store& store, Database& database, const fs::path& folder, Disk& disk) {
  const fs::path whole = folder / (std::string(k_database_file) + ".whole");
  const fs::path file = store.folder() / k_database_file;
  disk.remove(whole);
  database.connection().prepare("VACUUM INTO ?1").bind(1, whole.string()).run();
  // SQLite would replay a killed process's log into the new file.
  std::error_code error;
  if (fs::exists(file.string() + "-wal", error))
    for (const char* side : {"", "-wal", "-shm"})
      disk.remove(file.string() + side);
  disk.copy(whole, file);
  disk.remove(whole);
}

bool is_read_only(const fs::path& folder) {
  return ::access(folder.c_str(), W_OK) != 0 && (errno == EROFS || errno == EACCES);
}

fs::path database_beside(const fs::path& store, const fs::path& state, bool may_make) {
  std::error_code error;
  if (!is_read_only(store) || store == state || fs::equivalent(store, state, error)) return {};
  const bool is_there = fs::exists(state / k_database_file, error) && !is_read_only(state);
  return may_make || is_there ? state : fs::path();
}

void refuse_read_only(const fs::path& folder, std::string_view why) {
  if (!is_read_only(folder)) return;
  fail(
      ErrorKind::io,
      "{0}: cannot write there: {1}; {2}: dsbuild store gather {0} MINE takes what it has into one "
      "of your own, for build --store MINE",
      folder.string(), std::generic_category().message(errno), why);
}

}  // namespace ds
