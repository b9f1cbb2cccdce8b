// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace ds {

/// The database file is no database, or its pages contradict each other. Kept apart from other
/// failures because it is the one that is mended by setting the file aside.
class DamagedDatabase : public Error {
 public:
  explicit DamagedDatabase(const std::string& message) : Error(ErrorKind::io, message) {}
};

class Connection;

/// A prepared statement borrowed from its connection and reset when this goes; other threads wait
/// for the connection until then. Parameters and
/// columns count from 1 and 0, as in SQLite. Every call throws Error(io) with the file and SQLite's
/// reason, or DamagedDatabase.
class Statement {
 public:
  Statement(Connection& connection, sqlite3_stmt* handle)
      : lock_(lock_of(connection)), connection_(connection), handle_(handle) {}
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);
  Statement& bind(int parameter, std::string_view value);
  Statement& bind(int parameter, const char* value) {
    return bind(parameter, std::string_view(value));
  }
  /// Counts and sizes; a value of 2^63 or more is a bug.
  Statement& bind_count(int parameter, std::uint64_t value);
  /// NULL where there is no value.
  Statement& bind_optional(int parameter, std::optional<double> value);

  /// True where there is a row to read.
  bool step();
  /// For statements that give no rows.
  void run();

  std::int64_t integer(int column) const;
  std::uint64_t count(int column) const;
  double real(int column) const;
  std::optional<double> optional_real(int column) const;
  std::string text(int column) const;
  /// The same without a copy, until the next `step`.
  std::string_view view(int column) const;

 private:
  static std::unique_lock<std::recursive_mutex> lock_of(Connection& connection);

  std::unique_lock<std::recursive_mutex> lock_;  ///< goes last
  Connection& connection_;
  sqlite3_stmt* handle_;
};

/// One open SQLite file, which any number of processes may have open. Threads take turns: a
/// statement, a snapshot or a transaction holds the connection as long as it lives.
class Connection {
 public:
  /// Opens or makes the file, in WAL mode with synchronous = FULL: a transaction that returned
  /// survives a power cut. An empty path is a database in memory.
  explicit Connection(const std::filesystem::path& file);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// `sql` must be a literal: its address is the key of the cache. No statement may be in use twice
  /// at once.
  Statement prepare(const char* sql);
  /// Runs statements that take no parameters and give no rows.
  void execute(const char* sql);
  /// Throws DamagedDatabase where SQLite's quick_check finds anything.
  void check();
  /// Rows the last statement changed.
  int changes() const;
  /// How often prepared statements were run: what a command asks, for tests of what it costs.
  std::int64_t runs() const;

 private:
  friend class Statement;
  friend class Snapshot;
  friend class Transaction;
  [[noreturn]] void fail_sqlite(int code) const;

  mutable std::recursive_mutex mutex_;
  std::string name_;
  sqlite3* handle_ = nullptr;
  std::map<const char*, sqlite3_stmt*> statements_;
};

/// Everything read while it lives is of one moment, and locks are taken once instead of for every
/// statement. Nothing may be written meanwhile, and no other be open.
class Snapshot {
 public:
  explicit Snapshot(Connection& connection);
  ~Snapshot();
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;

 private:
  std::unique_lock<std::recursive_mutex> lock_;
  Connection& connection_;
};

/// BEGIN IMMEDIATE ... COMMIT; rolled back where it goes without `commit`. Not nestable.
class Transaction {
 public:
  explicit Transaction(Connection& connection);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  std::unique_lock<std::recursive_mutex> lock_;
  Connection& connection_;
  bool open_ = true;
};

}  // namespace ds
