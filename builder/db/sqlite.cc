// SPDX-License-Identifier: Apache-2.0
#include "builder/db/sqlite.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/files.h"

#include <sqlite3.h>

#include <limits>

namespace ds {
namespace {

/// How long a statement waits for another process's transaction. Transactions here take
/// milliseconds, but a disk under load can hold one up for many seconds.
constexpr int k_busy_timeout_ms = 120'000;

/// Changing a new file to WAL takes an exclusive lock for which SQLite does not call the busy
/// handler: where two processes open the file at once, the second is told "locked" without a wait.
int enter_wal_mode(sqlite3* handle) {
  constexpr int step_ms = 10;
  for (int waited_ms = 0;; waited_ms += step_ms) {
    const int code = sqlite3_exec(handle, "PRAGMA journal_mode = WAL", nullptr, nullptr, nullptr);
    if ((code & 0xff) != SQLITE_BUSY || waited_ms >= k_busy_timeout_ms) return code;
    sqlite3_sleep(step_ms);
  }
}

}  // namespace

Connection::Connection(const std::filesystem::path& file)
    : name_(file.empty() ? ":memory:" : file.string()) {
  if (!file.empty() && file.has_parent_path()) make_folders(file.parent_path());
  const int code = sqlite3_open_v2(
      name_.c_str(), &handle_,
      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE,
      nullptr);
  try {
    if (code != SQLITE_OK) fail_sqlite(code);
    sqlite3_busy_timeout(handle_, k_busy_timeout_ms);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the only form of this call
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    if (!file.empty()) {
      const int wal = enter_wal_mode(handle_);
      if (wal != SQLITE_OK) fail_sqlite(wal);
    }
    execute("PRAGMA synchronous = FULL");
    execute("PRAGMA foreign_keys = ON");
  } catch (...) {
    sqlite3_close(handle_);
    throw;
  }
}

Connection::~Connection() {
  for (const auto& [sql, statement] : statements_)
    sqlite3_finalize(statement);
  sqlite3_close(handle_);
}

void Connection::fail_sqlite(int code) const {
  const std::string reason = handle_ != nullptr ? sqlite3_errmsg(handle_) : sqlite3_errstr(code);
  const int primary = code & 0xff;
  if (primary == SQLITE_CORRUPT || primary == SQLITE_NOTADB)
    throw DamagedDatabase(fmt::format("{}: the database is damaged: {}", name_, reason));
  throw DiskFailed(fmt::format("{}: {}", name_, reason));
}

Statement Connection::prepare(const char* sql) {
  const std::lock_guard lock(mutex_);
  sqlite3_stmt*& statement = statements_[sql];
  if (statement == nullptr) {
    const int code =
        sqlite3_prepare_v3(handle_, sql, -1, SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
    if (code != SQLITE_OK) fail_sqlite(code);
  }
  DS_ASSERT(sqlite3_stmt_busy(statement) == 0);
  return {*this, statement};
}

void Connection::execute(const char* sql) {
  const std::lock_guard lock(mutex_);
  const int code = sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail_sqlite(code);
}

void Connection::check() {
  Statement statement = prepare("PRAGMA quick_check(1)");
  if (!statement.step() || statement.text(0) != "ok")
    throw DamagedDatabase(fmt::format("{}: the database is damaged: {}", name_, statement.text(0)));
}

int Connection::changes() const {
  const std::lock_guard lock(mutex_);
  return sqlite3_changes(handle_);
}

std::int64_t Connection::runs() const {
  const std::lock_guard lock(mutex_);
  std::int64_t runs = 0;
  for (const auto& [sql, statement] : statements_)
    runs += sqlite3_stmt_status(statement, SQLITE_STMTSTATUS_RUN, 0);
  return runs;
}

std::unique_lock<std::recursive_mutex> Statement::lock_of(Connection& connection) {
  return std::unique_lock(connection.mutex_);
}

Statement::~Statement() {
  // The code repeats what `step` reported already.
  sqlite3_reset(handle_);
  sqlite3_clear_bindings(handle_);
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  const int code = sqlite3_bind_int64(handle_, parameter, value);
  if (code != SQLITE_OK) connection_.fail_sqlite(code);
  return *this;
}

Statement& Statement::bind(int parameter, double value) {
  const int code = sqlite3_bind_double(handle_, parameter, value);
  if (code != SQLITE_OK) connection_.fail_sqlite(code);
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view value) {
  // Not null for an empty view: a null pointer would bind NULL. The destructor argument makes
  // SQLite copy.
  const char* data = value.data() != nullptr ? value.data() : "";
  const auto copy =  // NOLINTNEXTLINE(performance-no-int-to-ptr): never followed
      reinterpret_cast<sqlite3_destructor_type>(-1);  // SQLITE_TRANSIENT without its C cast
  const int code = sqlite3_bind_text64(handle_, parameter, data, value.size(), copy, SQLITE_UTF8);
  if (code != SQLITE_OK) connection_.fail_sqlite(code);
  return *this;
}

Statement& Statement::bind_count(int parameter, std::uint64_t value) {
  DS_ASSERT(value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()));
  return bind(parameter, static_cast<std::int64_t>(value));
}

Statement& Statement::bind_optional(int parameter, std::optional<double> value) {
  if (value) return bind(parameter, *value);
  const int code = sqlite3_bind_null(handle_, parameter);
  if (code != SQLITE_OK) connection_.fail_sqlite(code);
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(handle_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) connection_.fail_sqlite(code);
  return false;
}

void Statement::run() {
  const bool row = step();
  DS_ASSERT(!row);
  sqlite3_reset(handle_);
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(handle_, column);
}

std::uint64_t Statement::count(int column) const {
  const std::int64_t value = integer(column);
  if (value < 0)
    throw DamagedDatabase(
        fmt::format("{}: the database is damaged: count {}", connection_.name_, value));
  return static_cast<std::uint64_t>(value);
}

double Statement::real(int column) const {
  return sqlite3_column_double(handle_, column);
}

std::optional<double> Statement::optional_real(int column) const {
  if (sqlite3_column_type(handle_, column) == SQLITE_NULL) return std::nullopt;
  return real(column);
}

std::string Statement::text(int column) const {
  return std::string(view(column));
}

std::string_view Statement::view(int column) const {
  const unsigned char* text = sqlite3_column_text(handle_, column);
  if (text == nullptr) return {};
  return {reinterpret_cast<const char*>(text),
          static_cast<std::size_t>(sqlite3_column_bytes(handle_, column))};
}

Snapshot::Snapshot(Connection& connection) : lock_(connection.mutex_), connection_(connection) {
  connection_.execute("BEGIN");
}

Snapshot::~Snapshot() {
  try {
    connection_.execute("COMMIT");
  } catch (const Error&) {
    // Nothing was written that could be lost.
  }
}

Transaction::Transaction(Connection& connection)
    : lock_(connection.mutex_), connection_(connection) {
  // IMMEDIATE: taking the write lock at the first write instead can fail at once with SQLITE_BUSY
  // where another process wrote after this one read, whatever the timeout.
  connection_.execute("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  if (!open_) return;
  try {
    connection_.execute("ROLLBACK");
  } catch (const Error&) {
    // SQLite has rolled back by itself (full disk); there is nothing left to undo.
  }
}

void Transaction::commit() {
  connection_.execute("COMMIT");
  open_ = false;
}

}  // namespace ds
