// SPDX-License-Identifier: Apache-2.0
#include "builder/store/store_database.h"

#include "builder/store/made_record.h"
#include "tracer/base/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ds {
namespace {

namespace fs = std::filesystem;

MadeProduct some_product(std::uint64_t i) {
  MadeProduct made{{{i, 1}, "film", {i, 2}, 10 + i, std::string(64, 'a'), {i, 3}, 0.5, i, {}, {}},
                   {2.5, "a \"device\""}};
  made.product.facts.infinite_samples = i;
  return made;
}

TEST(MadeRecord, ReadsWhatItWrites) {
  const auto made = from_record(to_record({some_product(1), some_product(2)}));
  ASSERT_EQ(made.size(), 2U);
  EXPECT_EQ(made[1].product.key, (Hash128{2, 1}));
  EXPECT_EQ(made[1].product.object, (Hash128{2, 2}));
  EXPECT_EQ(made[1].product.size_bytes, 12U);
  EXPECT_EQ(made[1].product.pixels, (Hash128{2, 3}));
  EXPECT_EQ(made[1].product.tone_map_scale, 0.5);
  EXPECT_EQ(made[1].product.rejected_samples, 2U);
  EXPECT_EQ(made[1].product.facts, some_product(2).product.facts);
  EXPECT_EQ(made[1].run.seconds, 2.5);
  EXPECT_EQ(made[1].run.device, "a \"device\"");
}

TEST(MadeRecord, ReadsRecordsOfBeforeTheFacts) {
  std::string text = to_record({some_product(1)});
  const std::size_t at = text.find("\"facts\":{"), end = text.find("},", at) + 2;
  ASSERT_NE(at, std::string::npos);
  text.erase(at, end - at);
  const auto made = from_record(text);
  ASSERT_EQ(made.size(), 1U);
  EXPECT_EQ(made[0].product.facts, FilmFacts{});
  EXPECT_EQ(made[0].product.rejected_samples, 1U);
}

TEST(MadeRecord, RefusesOtherTexts) {
  EXPECT_THROW(from_record("{\"facts\":3}\n"), UnreadableRecord);
  EXPECT_THROW(from_record("{\"key\":1}\n"), UnreadableRecord);
  EXPECT_THROW(from_record("{\"key\":\"zz\"}\n"), UnreadableRecord);
  EXPECT_THROW(from_record("no json\n"), UnreadableRecord);
}

void expect_lines(const std::string& text) {
  const std::vector<MadeProduct> made = from_record(text);
  const std::vector<RecordLine> lines = record_lines(text);
  ASSERT_EQ(lines.size(), made.size());
  std::string all;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].key, made[i].product.key);
    EXPECT_EQ(lines[i].object, made[i].product.object);
    EXPECT_EQ(lines[i].kind, made[i].product.kind);
    all += lines[i].text;
  }
  EXPECT_EQ(all, text);
}

TEST(MadeRecord, SaysTheSameAtAGlance) {
  MadeProduct tricky = some_product(3);
  tricky.run.device = R"(,"key":"00000000000000000000000000000000","object":"a\b")";
  tricky.product.pixel_counts.objects = {ObjectCounts{101, 1, 2, 3, 4, 5, 6, 7}};
  tricky.product.relative_error = 0.5;
  const std::string text = to_record({some_product(1), tricky, some_product(2)});
  expect_lines(text);
  expect_lines("");
  // Other orders and spaces of the same members.
  std::string other = to_record({some_product(1)});
  const std::size_t key = other.find(",\"key\":"), kind = other.find(",\"kind\":");
  const std::string member = other.substr(key, kind - key);
  other.erase(key, kind - key);
  other.insert(other.size() - 2, member);
  expect_lines(other);
  expect_lines(text.substr(0, text.size() - 1));
  for (const std::size_t length : {std::size_t{5}, text.find("\"object\"") + 15, text.size() - 3})
    EXPECT_THROW(record_lines(text.substr(0, length)), UnreadableRecord) << length;
  EXPECT_THROW(record_lines(text + "\n"), UnreadableRecord);
  EXPECT_THROW(record_lines("no json\n"), UnreadableRecord);
}

class StoreDatabaseTest : public testing::Test {
 protected:
  std::unique_ptr<Database> open() { return open_database(store_, claims_); }
  void damage() {
    write_file_atomic(file_, std::string_view("not a database at all, though a file of the name"));
  }

  TemporaryFolder folder_;
  RealDisk disk_;
  Store store_{folder_.path(), disk_};
  Claims claims_{folder_.path() / "lock"};
  fs::path file_ = folder_.path() / "dsbuild.sqlite";
};

TEST_F(StoreDatabaseTest, RefillsADamagedDatabaseFromTheRecords) {
  store_.put_record(to_record({some_product(1), some_product(2)}));
  open()->put_product(some_product(1).product, {});
  damage();
  const auto database = open();
  EXPECT_TRUE(database->find_product({1, 1}));
  EXPECT_TRUE(database->find_product({2, 1}));
  EXPECT_TRUE(fs::exists(file_.string() + ".damaged"));
}

TEST_F(StoreDatabaseTest, RefillsALostDatabaseFromTheRecordsItCanRead) {
  store_.put_record("of another version\n");
  store_.put_record(to_record({some_product(1)}));
  EXPECT_TRUE(open()->find_product({1, 1}));
}

TEST_F(StoreDatabaseTest, LeavesADamagedDatabaseThatAnotherHasOpen) {
  open();
  damage();
  Claims other(folder_.path() / "lock");
  other.share_database();
  try {
    open();
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("while another dsbuild has it open"));
  }
  EXPECT_FALSE(fs::exists(file_.string() + ".damaged"));
}

TEST(Claims, GiveAnImageToOneAtATime) {
  const TemporaryFolder folder;
  Claims one(folder.path() / "lock"), other(folder.path() / "lock");
  one.share_database();
  other.share_database();
  auto claim = one.try_image({5, 6});
  ASSERT_TRUE(claim);
  EXPECT_FALSE(other.try_image({5, 6}));
  EXPECT_TRUE(other.try_image({5, 7}));
  claim.reset();
  EXPECT_TRUE(other.try_image({5, 6}));
  EXPECT_FALSE(one.try_own_database());
}

}  // namespace
}  // namespace ds
