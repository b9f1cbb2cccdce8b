// SPDX-License-Identifier: Apache-2.0
#include "builder/db/database.h"

#include "builder/db/named_products.h"
#include "builder/db/schema.h"
#include "builder/db/unused_texts.h"
#include "tracer/base/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

namespace ds {
namespace {

using testing::HasSubstr;

constexpr Hash128 k_a{1, 2}, k_b{3, 4};

TEST(Database, RemembersAProductAndReplacesIt) {
  Database database({});
  EXPECT_FALSE(database.find_product(k_a));
  Product product{k_a, "image", k_b, 17, std::string(64, 'f'), k_a, 0.25, 3, {}, {}};
  product.facts.samples = std::uint64_t{1} << 40;
  product.facts.error_low = 0.1;
  database.put_product(product, {1.5, "a device"});
  product.object = k_a;
  database.put_product(product, {});
  const auto found = database.find_product(k_a);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, "image");
  EXPECT_EQ(found->object, k_a);
  EXPECT_EQ(found->size_bytes, 17U);
  EXPECT_EQ(found->sha256, std::string(64, 'f'));
  EXPECT_EQ(found->pixels, k_a);
  EXPECT_EQ(found->tone_map_scale, 0.25);
  EXPECT_EQ(found->rejected_samples, 3U);
  EXPECT_EQ(found->facts, product.facts);
}

TEST(Database, KeepsPixelCountsAndAddsThoseThatWereNotMade) {
  Database database{std::filesystem::path()};
  Product product{k_a, "mask", k_b, 17, std::string(64, 'f'), k_a, 1, 0, {}, {}};
  product.pixel_counts.model = 5;
  database.put_product(product, {});
  EXPECT_EQ(database.find_product(k_a)->pixel_counts, product.pixel_counts);
  database.add_pixel_counts(k_a, {{}, {}, 7, 2});
  EXPECT_EQ(database.find_product(k_a)->pixel_counts, (PixelCounts{{}, {}, 5, 2}));
  EXPECT_EQ(database.find_product(k_a)->facts, product.facts);
  database.add_pixel_counts(k_b, {1, 1, 1, 1});  // nobody's
  EXPECT_FALSE(database.find_product(k_b));
}

TEST(Database, KnowsTextsThatNoImageNeeds) {
  Database database{std::filesystem::path()};
  const auto put = [&](const std::string& body) {
    database.put_text(hash_text(body), body);
    return hash_text(body);
  };
  const Hash128 deep = put("far below"), unused = put("nobody's"), of_other = put("of the other");
  const Hash128 middle = put("program: @" + deep.hex() + "\nscale: 1 @ " + unused.hex() + "\n");
  const Hash128 part = put("kd: @" + middle.hex());
  database.put_image("d", "a", {part, k_a, k_a, k_a, k_a, k_a});
  database.put_image("e", "a", {k_b, of_other, k_a, k_a, k_a, part});
  EXPECT_EQ(unused_texts(database, {}), std::vector{unused});
  EXPECT_THAT(unused_texts(database, {"e"}), testing::UnorderedElementsAre(unused, of_other));
  EXPECT_EQ(unused_texts(database, {"d", "e"}).size(), 5U);
  remove_text(database, unused);
  EXPECT_FALSE(database.find_text(unused));
  EXPECT_TRUE(database.find_text(deep));
}

TEST(Database, GivesBackWhatHoldsNothing) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a.sqlite";
  Database database(file);
  for (std::uint64_t i = 0; i < 200; ++i)
    database.put_text({i, i}, std::string(4000, 'x'));
  EXPECT_EQ(size_of(database).free_bytes, 0U);
  for (std::uint64_t i = 0; i < 190; ++i)
    remove_text(database, {i, i});
  const DatabaseSize before = size_of(database);
  EXPECT_GE(before.free_bytes, 190U * 4000);
  shrink(database);
  const DatabaseSize after = size_of(database);
  EXPECT_EQ(after.free_bytes, 0U);
  EXPECT_EQ(after.bytes, std::filesystem::file_size(file)) << "the log is empty";
  EXPECT_LE(after.bytes, before.bytes - before.free_bytes);
  EXPECT_TRUE(database.find_text({195, 195}));
}

TEST(Database, KeepsSpheresByModelAndReader) {
  Database database{std::filesystem::path()};
  EXPECT_FALSE(database.find_sphere(k_a, 1));
  database.put_sphere(k_a, 1, {0.1, -0.2, 0.3, 1.0 / 3});
  EXPECT_EQ(database.find_sphere(k_a, 1), (std::array{0.1, -0.2, 0.3, 1.0 / 3}));
  EXPECT_FALSE(database.find_sphere(k_a, 2));
  EXPECT_FALSE(database.find_sphere(k_b, 1));
}

TEST(Database, KeepsBoundsOfImagesByReader) {
  Database database{std::filesystem::path()};
  const std::array<float, 6> bounds{0, 0.1F, 1e-30F, 0.3F, 1.0F / 3, 7e20F};
  EXPECT_FALSE(database.find_image_bounds(k_a, 1));
  database.put_image_bounds(k_a, 1, bounds);
  EXPECT_EQ(database.find_image_bounds(k_a, 1), bounds);
  EXPECT_FALSE(database.find_image_bounds(k_a, 2));
  EXPECT_FALSE(database.find_image_bounds(k_b, 1));
}

TEST(Database, KnowsAFileByEveryPartOfItsStamp) {
  Database database({});
  const FileStamp stamp{10, 20, 25, 30};
  database.put_content("/a/file", stamp, k_a);
  EXPECT_EQ(database.find_content("/a/file", stamp), k_a);
  EXPECT_FALSE(database.find_content("/a/other", stamp));
  EXPECT_FALSE(database.find_content("/a/file", {11, 20, 25, 30}));
  EXPECT_FALSE(database.find_content("/a/file", {10, 21, 25, 30}));
  EXPECT_FALSE(database.find_content("/a/file", {10, 20, 26, 30}));
  EXPECT_FALSE(database.find_content("/a/file", {10, 20, 25, 31}));
}

TEST(Database, KeepsModelsByTheVersionOfTheirReader) {
  Database database({});
  const MeshExtent extent{{{-0.1, 1.0 / 3, -7e17}, {0, 1e-300, 5}}, {-0.05, 0.1, -1e17}};
  const KnownModel whole{{k_b, {}, {}, {}}, {}, extent};
  const KnownModel mended{{k_b, k_a, k_b, k_a}, {{"out_of_range", 2}, {"non_finite", 1}}, extent};
  database.put_model(k_a, 1, whole);
  EXPECT_EQ(database.find_model(k_a, 1), whole);
  EXPECT_FALSE(database.find_model(k_a, 2));
  database.put_model(k_a, 1, mended);
  EXPECT_EQ(database.find_model(k_a, 1), mended);
  database.connection().execute("UPDATE geometry SET damage = '{}x'");
  EXPECT_THROW(database.find_model(k_a, 1), DamagedDatabase);
}

TEST(Database, KeepsDatasetsApart) {
  Database database({});
  PartHashes parts{};
  parts[4] = k_b;
  database.put_image("one", "a/0", parts);
  database.put_placed("one", {"images/a/0.png", "a/0", "image", k_a, k_b, FileStamp{1, 2, 4, 3}});
  database.put_placed("one", {"images/a/0.mask.png", "a/0", "mask", k_a, k_b, std::nullopt});
  EXPECT_TRUE(database.images("two").empty());
  EXPECT_TRUE(database.placed_files("two").empty());
  EXPECT_EQ(database.images("one").at("a/0"), parts);
  const auto placed = database.placed_files("one");
  EXPECT_EQ(placed.at("images/a/0.png").stamp, (FileStamp{1, 2, 4, 3}));
  EXPECT_EQ(placed.at("images/a/0.mask.png").stamp, std::nullopt);
  database.remove_placed("one", "images/a/0.png");
  database.remove_image("one", "a/0");
  EXPECT_EQ(database.placed_files("one").size(), 1U);
  EXPECT_TRUE(database.images("one").empty());
}

TEST(Database, KeepsADatasetAndItsOverrides) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  const DatasetRow row{"id", "name", "/r/x.toml", "/w", {"a=\"b\"", "c=[1, 2]"}, k_a};
  {
    Database database(file);
    database.put_dataset(row);
    database.set_manifest("id", k_b);
  }
  Database database(file);
  const auto found = database.find_dataset("id");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->overrides, row.overrides);
  EXPECT_EQ(found->recipe, row.recipe);
  EXPECT_EQ(found->working_folder, row.working_folder);
  EXPECT_EQ(found->manifest, k_b);
}

TEST(Database, LogsBuildsNewestFirst) {
  Database database({});
  database.begin_build("d", "host", 17);
  const std::int64_t second = database.begin_build("d", "host", 17);
  database.begin_build("other", "host", 17);
  database.update_build({second, "", "", 0, "a device", "done", 5, 3, 1, 1, 4096, 2.5});
  const auto builds = database.builds("d");
  ASSERT_EQ(builds.size(), 2U);
  EXPECT_EQ(builds[0].number, second);
  EXPECT_EQ(builds[0].outcome, "done");
  EXPECT_EQ(builds[0].built, 3U);
  EXPECT_EQ(builds[0].traced_samples, 4096U);
  EXPECT_EQ(builds[0].seconds, 2.5);
  EXPECT_EQ(builds[0].host, "host");
  EXPECT_EQ(builds[0].process, 17);
  EXPECT_EQ(builds[1].outcome, "running");
}

TEST(Database, KeepsWhatOneProgramFoundOut) {
  Database database{std::filesystem::path()};
  EXPECT_FALSE(database.find_known("one", "what?"));
  database.put_known("one", "what?", "this");
  database.put_known("one", "where?", "here");
  EXPECT_EQ(database.find_known("one", "what?"), "this");
  database.put_known("one", "what?", "that");
  EXPECT_EQ(database.find_known("one", "what?"), "that");
  EXPECT_FALSE(database.find_known("two", "what?"));
  database.put_known("two", "what?", "it");
  EXPECT_EQ(database.find_known("two", "what?"), "it");
  EXPECT_FALSE(database.find_known("one", "where?")) << "of a program that is no more";
}

TEST(Database, ReadsAFileOfVersionOne) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  const Product product{k_a, "film", k_b, 17, std::string(64, 'f'), k_a, 0.25, 3, 0.5, {}};
  { Database(file).put_product(product, {}); }
  {
    Connection connection(file);
    connection.execute(
        "DROP INDEX product_capped; ALTER TABLE product DROP COLUMN facts; "
        "ALTER TABLE geometry DROP COLUMN damage; "
        "ALTER TABLE input_file DROP COLUMN ctime_ns; "
        "ALTER TABLE placed DROP COLUMN ctime_ns; DROP TABLE sphere; PRAGMA user_version = 1");
  }
  for (int opened = 0; opened < 2; ++opened) {
    Database database(file);
    const auto found = database.find_product(k_a);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->object, k_b);
    EXPECT_EQ(found->relative_error, 0.5);
    EXPECT_EQ(found->facts, FilmFacts{}) << "version 1 kept none";
  }
}

TEST(Database, ForgetsModelsOfVersionTwoWhoseDamageIsNotKnown) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  const Product product{k_a, "film", k_b, 17, std::string(64, 'f'), k_a, 0.25, 3, 0.5, {}};
  {
    Database database(file);
    database.put_product(product, {});
    database.put_model(k_a, 1, {{k_b, {}, {}, {}}, {}, {}});
  }
  Connection(file).execute(
      "ALTER TABLE geometry DROP COLUMN damage; "
      "ALTER TABLE input_file DROP COLUMN ctime_ns; "
      "ALTER TABLE placed DROP COLUMN ctime_ns; DROP TABLE sphere; PRAGMA user_version = 2");
  Database database(file);
  EXPECT_FALSE(database.find_model(k_a, 1));
  EXPECT_TRUE(database.find_product(k_a));
  database.put_model(k_a, 1, {{k_b, {}, {}, {}}, {{"non_finite", 1}}, {}});
  EXPECT_EQ(database.find_model(k_a, 1)->damage, (MendedDamage{{"non_finite", 1}}));
}

TEST(Database, TrustsNoStampOfVersionThreeWhichHadNoCtime) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  const FileStamp stamp{10, 20, 25, 30};
  {
    Database database(file);
    database.put_content("/a/file", stamp, k_a);
    database.put_placed("one", {"images/a/0.png", "a/0", "image", k_a, k_b, stamp});
  }
  Connection(file).execute(
      "ALTER TABLE input_file DROP COLUMN ctime_ns; "
      "ALTER TABLE placed DROP COLUMN ctime_ns; DROP TABLE sphere; PRAGMA user_version = 3");
  Database database(file);
  EXPECT_FALSE(database.find_content("/a/file", stamp));
  EXPECT_NE(database.placed_files("one").at("images/a/0.png").stamp, stamp);
  database.put_content("/a/file", stamp, k_b);
  EXPECT_EQ(database.find_content("/a/file", stamp), k_b);
}

TEST(Database, ForgetsModelsOfVersionSevenWhoseExtrasAreNotKnown) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  const KnownModel model{{k_b, k_a, {}, {}}, {}, {}};
  { Database(file).put_model(k_a, 1, model); }
  Connection(file).execute(
      "ALTER TABLE geometry DROP COLUMN uvs; ALTER TABLE geometry DROP COLUMN colors; "
      "ALTER TABLE geometry DROP COLUMN extent; DROP TABLE image_bounds; PRAGMA user_version = 7");
  Database database(file);
  EXPECT_FALSE(database.find_model(k_a, 1));
  database.put_model(k_a, 1, model);
  EXPECT_EQ(database.find_model(k_a, 1), model);
  EXPECT_FALSE(database.find_image_bounds(k_a, 1));
}

TEST(Database, ForgetsModelsOfVersionNineWhoseNormalsAreNotApart) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  const KnownModel model{{k_b, k_a, {}, k_b}, {}, {}};
  { Database(file).put_model(k_a, 1, model); }
  Connection(file).execute("ALTER TABLE geometry DROP COLUMN normals; PRAGMA user_version = 9");
  Database database(file);
  EXPECT_FALSE(database.find_model(k_a, 1));
  database.put_model(k_a, 1, model);
  EXPECT_EQ(database.find_model(k_a, 1), model);
}

TEST(Database, ForgetsModelsOfVersionTenWhoseCentroidIsNotKnown) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  const KnownModel model{{k_b, k_a, {}, k_b}, {}, {{{1, 2, 3}, {4, 5, 6}}, {2, 3, 4}}};
  { Database(file).put_model(k_a, 1, model); }
  Connection(file).execute(
      "ALTER TABLE geometry RENAME COLUMN extent TO box; UPDATE geometry SET box = "
      "'[1,2,3,4,5,6]'; PRAGMA user_version = 10");
  Database database(file);
  EXPECT_FALSE(database.find_model(k_a, 1));
  database.put_model(k_a, 1, model);
  EXPECT_EQ(database.find_model(k_a, 1), model);
}

TEST(Database, TakesFactsThatAreNoneForDamage) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  { Database(file).put_product({k_a, "film", k_b, 17, "", k_a, 0.25, 3, 0.5, {}}, {}); }
  { Connection(file).execute("UPDATE product SET facts = '{\"samples\":-1}'"); }
  EXPECT_THROW(Database(file).find_product(k_a), DamagedDatabase);
}

TEST(Database, RefusesAFileOfANewerProgram) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  { Database database(file); }
  { Connection(file).execute("PRAGMA user_version = 999"); }
  try {
    Database database(file);
    FAIL();
  } catch (const DamagedDatabase&) {
    FAIL() << "a newer file is not a damaged one";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("found 999: made by a newer dsbuild"));
  }
}

TEST(Database, TakesAnotherProgramsFileForDamaged) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  { Connection(file).execute("CREATE TABLE theirs (a)"); }
  EXPECT_THROW(Database{file}, DamagedDatabase);
}

TEST(Database, IsReadWholeOnlyWhereItIsNotAsItWasLeft) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "db.sqlite";
  { Database database(file); }
  EXPECT_FALSE(FileCheck(file).needed());
  {
    Database database(file);
    database.put_text(k_a, "text");
  }
  EXPECT_FALSE(FileCheck(file).needed());
  std::ofstream(file.string() + "-wal") << "of a process that was killed";
  EXPECT_TRUE(FileCheck(file).needed());
  std::filesystem::remove(file.string() + "-wal");
  EXPECT_FALSE(FileCheck(file).needed());
  std::ofstream(file, std::ios::app) << "other bytes";
  EXPECT_TRUE(FileCheck(file).needed());
  { FileCheck(file).passed(); }
  EXPECT_FALSE(FileCheck(file).needed());
  std::ofstream(file.string() + "-checked") << "17 torn";
  EXPECT_TRUE(FileCheck(file).needed());
}

TEST(Database, IsReadWholeAfterAnError) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "db.sqlite";
  try {
    Database database(file);
    database.put_text(k_a, "text");
    throw DamagedDatabase("found while it was used");
  } catch (const DamagedDatabase&) {
    EXPECT_TRUE(FileCheck(file).needed());
  }
}

TEST(Database, KnowsThePicturesThatLackSamples) {
  Database database({});
  Product product{k_a, "image", k_b, 17, "", k_a, 1, 3, {}, {}};
  database.put_product(product, {});
  product.key = k_b;
  product.rejected_samples = 0;
  database.put_product(product, {});
  EXPECT_EQ(database.pictures_with_rejected(), std::vector{k_a});
}

TEST(Database, KnowsThePicturesThatDidNotReachTheirError) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  {
    Database database(file);
    FilmFacts facts;
    database.put_product({k_b, "image", k_b, 17, "", k_a, 1, 0, {}, facts}, {});
    facts.capped = true;
    facts.developed_high = 0.125;
    database.put_product({k_a, "image", k_b, 17, "", k_a, 1, 0, {}, facts}, {});
    database.put_product({hash_text("film"), "film", k_b, 17, "", k_a, 1, 0, {}, facts}, {});
    EXPECT_EQ(database.capped_pictures(), (std::vector{std::pair(k_a, 0.125)}));
  }
  // Version 6 looked at every picture instead.
  Connection(file).execute("DROP INDEX product_capped; PRAGMA user_version = 6");
  EXPECT_EQ(Database(file).capped_pictures(), (std::vector{std::pair(k_a, 0.125)}));
  Connection(file).execute("UPDATE product SET facts = '{\"capped\":true' WHERE kind = 'image'");
  EXPECT_THROW(Database(file).capped_pictures(), DamagedDatabase);
}

TEST(Database, FindsAPageWithOtherBytes) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "db.sqlite";
  {
    Database database(file);
    for (std::uint64_t i = 0; i < 500; ++i)
      database.put_text({i, i}, std::string(100, 'x'));
  }
  std::string bytes = read_text_file(file);
  ASSERT_GT(bytes.size(), 20'000U);
  for (std::size_t i = 12'000; i < 16'000; ++i)
    bytes[i] = static_cast<char>(bytes[i] ^ 0x5a);
  write_file_atomic(file, bytes);
  EXPECT_THROW(Database{file}, DamagedDatabase);
}

TEST(FileStamp, ChangesWithAWriteAndIsAbsentWithoutAFile) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "f";
  EXPECT_FALSE(stamp_of(file));
  EXPECT_FALSE(stamp_of(folder.path())) << "a folder is no file";
  write_file_atomic(file, std::string_view("one"));
  const auto before = stamp_of(file);
  ASSERT_TRUE(before);
  EXPECT_EQ(before->size_bytes, 3U);
  EXPECT_TRUE(is_racy(*before));
  write_file_atomic(file, std::string_view("two"));
  EXPECT_NE(stamp_of(file), before) << "another inode at least";
}

TEST(FileStamp, ChangesWhenAFileIsWrittenInPlaceAndItsTimesAreSetBack) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "f";
  write_file_atomic(file, std::string_view("one"));
  const auto hour_ago = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
  std::filesystem::last_write_time(file, hour_ago);
  const auto before = stamp_of(file);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // a tick of the file system's clock
  std::ofstream(file, std::ios::binary) << "two";
  std::filesystem::last_write_time(file, hour_ago);
  const auto after = stamp_of(file);
  ASSERT_TRUE(before && after);
  EXPECT_EQ(after->mtime_ns, before->mtime_ns);
  EXPECT_EQ(after->inode, before->inode);
  EXPECT_NE(after, before);
}

TEST(FileStamp, IsRacyWhereTheFileMayStillBeBeingWritten) {
  using namespace std::chrono;
  const auto now = duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
  constexpr std::int64_t s = 1'000'000'000;
  const auto racy = [&](std::int64_t mtime, std::int64_t ctime) {
    return is_racy({1, now + mtime * s, now + ctime * s, 1});
  };
  EXPECT_TRUE(racy(-2, -2)) << "FAT's times are even seconds";
  EXPECT_FALSE(racy(-10, -10));
  EXPECT_TRUE(racy(-3600, -1)) << "written or moved just now, with its old time";
  EXPECT_TRUE(racy(-1, -3600)) << "where ctime is the time of creation";
  EXPECT_FALSE(racy(3600, -10)) << "a time to come that was set says nothing";
  EXPECT_TRUE(racy(3600, 3600)) << "the clock was set back";
}

}  // namespace
}  // namespace ds
