// SPDX-License-Identifier: Apache-2.0
#include "builder/db/sqlite.h"

#include "builder/db/database.h"
#include "tracer/base/files.h"

#include <gtest/gtest.h>

#include <atomic>
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

TEST(Sqlite, WaitsForAnotherWriter) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  Connection first(file);
  first.execute("CREATE TABLE t (a)");
  auto held = std::make_unique<Transaction>(first);
  std::thread other([&] {
    Connection second(file);
    Transaction transaction(second);  // waits
    second.execute("INSERT INTO t VALUES (2)");
    transaction.commit();
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  first.execute("INSERT INTO t VALUES (1)");
  held->commit();
  held.reset();
  other.join();
  EXPECT_EQ(count_rows(first), 2);
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
