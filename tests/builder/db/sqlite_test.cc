// SPDX-License-Identifier: Apache-2.0
#include "builder/db/sqlite.h"

#include "builder/db/database.h"
#include "tracer/base/files.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace ds {
namespace {

std::int64_t count_rows(Connection& connection) {
  Statement row = connection.prepare("SELECT count(*) FROM t");
  row.step();
  return row.integer(0);
}

TEST(Sqlite, RollsBackATransactionThatIsNotCommitted) {
  Connection connection({});
  connection.execute("CREATE TABLE t (a)");
  {
    Transaction transaction(connection);
    connection.execute("INSERT INTO t VALUES (1)");
  }
  EXPECT_EQ(count_rows(connection), 0);
  Transaction transaction(connection);
  connection.execute("INSERT INTO t VALUES (1)");
  transaction.commit();
  EXPECT_EQ(count_rows(connection), 1);
}

TEST(Sqlite, KeepsEveryByteOfAText) {
  Connection connection({});
  connection.execute("CREATE TABLE t (a TEXT NOT NULL)");
  const std::string text("a\0b\n\xff", 5);
  connection.prepare("INSERT INTO t VALUES (?1)").bind(1, text).run();
  connection.prepare("INSERT INTO t VALUES (?1)").bind(1, std::string_view()).run();
  Statement row = connection.prepare("SELECT a FROM t ORDER BY rowid");
  ASSERT_TRUE(row.step());
  EXPECT_EQ(row.text(0), text);
  ASSERT_TRUE(row.step());
  EXPECT_EQ(row.text(0), "");
}

/// One writer holds the database until the other has asked for it, and a while longer.
struct TwoWriters {
  bool entered_early = false;          ///< the other was let in while the first held it
  std::string error;                   ///< of the other; empty: it was let in
  std::chrono::milliseconds waited{};  ///< by the other
};

TwoWriters write_at_once(const std::filesystem::path& file, std::chrono::milliseconds hold) {
  TwoWriters result;
  Connection first(file);
  auto held = std::make_unique<Transaction>(first);
  std::atomic<bool> asked{false}, released{false};
  std::thread other([&] {
    try {
      Connection second(file);
      asked = true;
      const auto start = std::chrono::steady_clock::now();
      Transaction transaction(second);
      result.waited = std::chrono::duration_cast<std::chrono::milliseconds>(
          std::chrono::steady_clock::now() - start);
      result.entered_early = !released;
      second.execute("INSERT INTO t VALUES (2)");
      transaction.commit();
    } catch (const Error& error) {
      result.error = error.what();
    }
    asked = true;
  });
  while (!asked)
    std::this_thread::yield();
  std::this_thread::sleep_for(hold);
  first.execute("INSERT INTO t VALUES (1)");
  released = true;
  held->commit();
  held.reset();
  other.join();
  return result;
}

// Where the machine is busy the other may ask when the first has let go already, which shows
// nothing: then the first holds on for longer.
TEST(Sqlite, WaitsForAnotherWriter) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  Connection(file).execute("CREATE TABLE t (a)");
  std::int64_t rows = 0;
  for (std::chrono::milliseconds hold{50}; hold.count() < 10'000; hold *= 2) {
    const TwoWriters writers = write_at_once(file, hold);
    ASSERT_EQ(writers.error, "");
    ASSERT_FALSE(writers.entered_early);
    Connection connection(file);
    ASSERT_EQ(count_rows(connection), rows += 2);
    if (2 * writers.waited >= hold) return;
  }
  FAIL() << "the second writer never asked while the first held the database";
}

TEST(Sqlite, TellsADamagedFileFromOtherTrouble) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  write_file_atomic(
      file, std::string_view("this is no database, but long enough to be looked at as one"));
  EXPECT_THROW(Database{file}, DamagedDatabase);
  // A folder in its place is trouble, but nothing to set aside.
  try {
    Database database(folder.path());
    FAIL();
  } catch (const DamagedDatabase&) {
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io);
  }
}

/// A new file changes its journal mode under a lock that SQLite does not wait for by itself.
TEST(ConnectionTest, ManyOpenANewFileAtOnce) {
  for (int round = 0; round < 30; ++round) {
    const TemporaryFolder folder;
    std::atomic<int> failures{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i)
      threads.emplace_back([&] {
        try {
          Connection connection(folder.path() / "new.sqlite");
          connection.execute("CREATE TABLE IF NOT EXISTS t (x INTEGER)");
        } catch (const Error&) {
          ++failures;
        }
      });
    for (std::thread& thread : threads)
      thread.join();
    ASSERT_EQ(failures, 0) << "in round " << round;
  }
}

}  // namespace
}  // namespace ds
