// SPDX-License-Identifier: Apache-2.0
#include "builder/store/store.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/files.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <set>
#include <string>

namespace ds {
namespace {

namespace fs = std::filesystem;

class StoreTest : public testing::Test {
 protected:
  fs::path object_path(Hash128 hash) const {
    return folder_.path() / "store/objects" / hash.hex().substr(0, 2) / hash.hex().substr(2);
  }
  void damage(Hash128 hash) {
    const fs::path file = object_path(hash);
    std::string bytes = read_text_file(file);
    bytes[0] = static_cast<char>(bytes[0] ^ 1);
    write_file_atomic(file, bytes);
  }

  TemporaryFolder folder_;
  RealDisk disk_;
  Store store_{folder_.path() / "store", disk_};
};

TEST_F(StoreTest, GivesBackWhatWasPutUnderItsHash) {
  const Hash128 hash = store_.put(bytes_of("some bytes"));
  EXPECT_EQ(hash, hash_text("some bytes"));
  EXPECT_TRUE(store_.has(hash));
  const auto bytes = store_.get(hash);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(hash_bytes(*bytes), hash);
  EXPECT_EQ(store_.put(bytes_of("some bytes")), hash);
  EXPECT_FALSE(store_.get(hash_text("other bytes")));
}

TEST_F(StoreTest, MakesObjectsReadOnly) {
  const Hash128 hash = store_.put(bytes_of("some bytes"));
  EXPECT_EQ(fs::status(object_path(hash)).permissions() &
                (fs::perms::owner_write | fs::perms::others_write),
            fs::perms::none);
}

TEST_F(StoreTest, RemovesADamagedObjectAndTakesItAnew) {
  const Hash128 hash = store_.put(bytes_of("some bytes"));
  damage(hash);
  EXPECT_TRUE(store_.has(hash)) << "has() does not read";
  EXPECT_FALSE(store_.get(hash));
  EXPECT_FALSE(fs::exists(object_path(hash)));
  store_.put(bytes_of("some bytes"));
  EXPECT_TRUE(store_.intact(hash));
  damage(hash);
  store_.put(bytes_of("some bytes"));
  EXPECT_TRUE(store_.intact(hash)) << "put must not trust what lies there";
}

TEST_F(StoreTest, PlacesAnObjectOverAnOlderFileAndOverItself) {
  const Hash128 hash = store_.put(bytes_of("some bytes"));
  const fs::path target = folder_.path() / "a/b/file";
  write_file_atomic(target, std::string_view("older"));
  store_.place(hash, target);
  store_.place(hash, target);
  EXPECT_EQ(read_text_file(target), "some bytes");
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(target.parent_path()))
    ++files;
  EXPECT_EQ(files, 1U) << "no temporary stays behind";
}

TEST_F(StoreTest, ShowsWholeRecordsOnly) {
  store_.visit_records([](const std::string&) { FAIL() << "a new store has none"; });
  store_.put_record("one\n");
  store_.put_record("two\n");
  const Hash128 torn = hash_text("two\n");
  write_file_atomic(
      folder_.path() / "store/records" / torn.hex().substr(0, 2) / torn.hex().substr(2),
      std::string_view("tw"));
  write_file_atomic(folder_.path() / "store/records/ab/.left.over.tmp", std::string_view("x"));
  std::vector<std::string> seen;
  store_.visit_records([&](const std::string& text) { seen.push_back(text); });
  EXPECT_EQ(seen, std::vector<std::string>{"one\n"});
}

/// What may not be removed.
class KeepingDisk : public RealDisk {
  void remove(const fs::path& file) override { fail_system(file, "remove", EPERM); }
};

TEST_F(StoreTest, ADamagedFileThatStaysCountsAsAbsent) {
  const Hash128 hash = store_.put(bytes_of("some bytes"));
  damage(hash);
  KeepingDisk disk;
  Store store(store_.folder(), disk);
  EXPECT_FALSE(store.get(hash));
  EXPECT_EQ(store.examine(Store::Kind::object, hash), Store::Health::damaged);
  store.put(bytes_of("some bytes"));
  EXPECT_EQ(store.examine(Store::Kind::object, hash), Store::Health::whole);
  EXPECT_EQ(store.examine(Store::Kind::object, hash_text("none")), Store::Health::absent);
}

TEST_F(StoreTest, WritesToTheLocalStoreAndReadsBoth) {
  const Hash128 old = store_.put(bytes_of("old"));
  store_.put_record("old record");
  const fs::path own = folder_.path() / "local";
  Store both(store_.folder(), disk_, own);
  EXPECT_TRUE(both.has(old) && both.get(old));
  EXPECT_EQ(both.put(bytes_of("old")), old);
  EXPECT_FALSE(fs::exists(own)) << "what is there is not written again";
  const Hash128 made = both.put(bytes_of("new"));
  both.put_record("new record");
  EXPECT_TRUE(both.has(made) && both.get(made) && both.get_record(hash_text("new record")));
  EXPECT_FALSE(store_.has(made));
  EXPECT_TRUE(fs::exists(own / "objects" / made.hex().substr(0, 2) / made.hex().substr(2)));
  both.place(made, folder_.path() / "placed");
  EXPECT_EQ(read_text_file(folder_.path() / "placed"), "new");
  std::set<std::string> records;
  both.visit_records([&](const std::string& text) { records.insert(text); });
  EXPECT_EQ(records, (std::set<std::string>{"new record", "old record"}));
  damage(old);
  both.put(bytes_of("old"));
  EXPECT_TRUE(both.intact(old));
}

}  // namespace
}  // namespace ds
