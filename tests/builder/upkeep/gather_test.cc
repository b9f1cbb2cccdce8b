// SPDX-License-Identifier: Apache-2.0
#include "builder/upkeep/gather.h"

#include "builder/store/made_record.h"
#include "tracer/base/disk_error.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace ds {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

/// Refuses to write once so many files were written.
class FillingDisk : public RealDisk {
 public:
  int left = 1 << 30;
  void write_all(std::span<const FileToWrite> files) override {
    for (const FileToWrite& one : files) {
      if (left-- <= 0) throw DiskFailed("no space left");
      write(one.file, one.bytes);
    }
  }
};

class GatherTest : public testing::Test {
 protected:
  /// A record of objects with these bytes, which `store` gets.
  Hash128 add(Store& store, const std::vector<std::string>& contents) {
    std::vector<MadeProduct> made;
    for (const std::string& content : contents) {
      MadeProduct one{};
      one.product.key = hash_text("key of " + content);
      one.product.kind = "image";
      one.product.object = store.put(bytes_of(content));
      one.product.size_bytes = content.size();
      one.product.sha256 = std::string(64, 'a');
      made.push_back(one);
    }
    const std::string text = to_record(made);
    store.put_record(text);
    return hash_text(text);
  }
  fs::path path(const Store& store, const char* kind, Hash128 hash) {
    return store.folder() / kind / hash.hex().substr(0, 2) / hash.hex().substr(2);
  }
  void damage(const fs::path& file) {
    std::string bytes = read_text_file(file);
    bytes[0] = static_cast<char>(bytes[0] ^ 1);
    write_file_atomic(file, bytes);
  }
  std::size_t files(const Store& store) {
    std::size_t count = 0;
    for (const auto kind : {Store::Kind::object, Store::Kind::record})
      store.visit_files(kind, [&](const Store::StoredFile&) { ++count; });
    return count;
  }
  GatherResult gather_all(bool move = false) {
    return gather(from_, to_, {.move = move, .database = &database_, .progress = {}}, stop_);
  }

  TemporaryFolder folder_;
  FillingDisk disk_;
  Store from_{folder_.path() / "from", disk_}, to_{folder_.path() / "to", disk_};
  Database database_{fs::path()};
  std::atomic<bool> stop_{false};
};

TEST_F(GatherTest, TakesWhatTheOtherLacksOnce) {
  add(from_, {"a picture", "a mask"});
  add(from_, {"another picture", "a mask"});
  add(to_, {"a picture of its own"});
  GatherResult result = gather_all();
  EXPECT_EQ(result.objects.files, 3U);
  EXPECT_EQ(result.records.files, 2U);
  EXPECT_EQ(result.objects.bytes, 9U + 15U + 6U);
  EXPECT_EQ(result.there.files, 0U);
  EXPECT_EQ(files(to_), 2U + 5U);
  EXPECT_EQ(files(from_), 5U);
  EXPECT_TRUE(to_.intact(hash_text("a mask")));
  const auto product = database_.find_product(hash_text("key of another picture"));
  ASSERT_TRUE(product);
  EXPECT_EQ(product->object, hash_text("another picture"));
  result = gather_all();
  EXPECT_EQ(result.objects.files + result.records.files, 0U);
  EXPECT_EQ(result.there.files, 5U);
  EXPECT_TRUE(result.faults.empty());
}

TEST_F(GatherTest, DoesNotTakeWhatIsDamagedAndLeavesIt) {
  const Hash128 record = add(from_, {"a picture", "a mask"});
  const Hash128 other = add(from_, {"another picture"});
  damage(path(from_, "objects", hash_text("a picture")));
  damage(path(from_, "records", other));
  const GatherResult result = gather_all();
  EXPECT_THAT(result.faults,
              testing::UnorderedElementsAre(EndsWith(": is damaged"), EndsWith(": is damaged")));
  EXPECT_EQ(result.objects.files, 1U) << "the mask is taken, with the record that names it";
  EXPECT_EQ(result.records.files, 1U);
  EXPECT_FALSE(to_.has(hash_text("a picture")));
  EXPECT_TRUE(to_.has(hash_text("a mask")));
  EXPECT_EQ(to_.examine(Store::Kind::record, record), Store::Health::whole);
  EXPECT_EQ(result.unrecorded.files, 1U) << "of the damaged record";
  EXPECT_EQ(files(from_), 5U);
}

TEST_F(GatherTest, CountsWhatNeitherHas) {
  add(from_, {"a picture", "a mask"});
  fs::remove(path(from_, "objects", hash_text("a picture")));
  EXPECT_EQ(gather_all().missing, 1U);
  add(to_, {"a picture"});
  EXPECT_EQ(gather_all().missing, 0U);
}

TEST_F(GatherTest, SaysWhatItCannotReadOfAnotherVersion) {
  from_.put_record("of another version");
  from_.put(bytes_of("a picture"));
  const GatherResult result = gather_all();
  EXPECT_THAT(result.faults,
              ElementsAre(HasSubstr(hash_text("of another version").hex().substr(2))));
  EXPECT_EQ(result.unrecorded.files, 1U);
  EXPECT_EQ(files(to_), 0U);
}

TEST_F(GatherTest, MovesOnlyWhatTheOtherHas) {
  add(from_, {"a picture", "a mask"});
  add(to_, {"a mask"});
  from_.put(bytes_of("of an image under way"));
  damage(path(to_, "objects", hash_text("a mask")));
  GatherResult result = gather_all(true);
  EXPECT_EQ(result.objects.files, 2U) << "the other's own was damaged";
  EXPECT_TRUE(to_.intact(hash_text("a mask")));
  EXPECT_EQ(files(from_), 1U);
  EXPECT_TRUE(from_.has(hash_text("of an image under way")));
  // Its record, which is written only now, still brings all.
  add(from_, {"of an image under way", "a mask"});
  result = gather_all(true);
  EXPECT_EQ(result.objects.files, 1U);
  EXPECT_EQ(result.missing, 0U);
  EXPECT_EQ(files(from_), 0U);
}

TEST_F(GatherTest, AFullDiskLosesNothing) {
  for (const char* one : {"a", "b", "c", "d"})
    add(from_, {one});
  disk_.left = 6;  // four objects, two records
  EXPECT_THROW(gather_all(true), DiskFailed);
  EXPECT_EQ(files(from_), 8U) << "nothing goes before all under way is written";
  disk_.left = 1 << 30;
  EXPECT_EQ(gather_all(true).records.files, 2U);
  EXPECT_EQ(files(from_), 0U);
  EXPECT_EQ(files(to_), 8U);
}

TEST_F(GatherTest, StopsWhereItIsTold) {
  add(from_, {"a"});
  stop_ = true;
  EXPECT_THROW(gather_all(), Error);
  EXPECT_EQ(files(to_), 0U);
}

}  // namespace
}  // namespace ds
