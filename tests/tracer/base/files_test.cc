// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/files.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/file_batch.h"
#include "tracer/base/hash.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace ds {
namespace {

namespace fs = std::filesystem;

auto entries(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), {});
}

TEST(FilesTest, writes_replaces_and_makes_parents) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a" / "b" / "c.txt";
  write_file_atomic(file, "one");
  write_file_atomic(file, "two");
  EXPECT_EQ(read_text_file(file), "two");
  EXPECT_EQ(entries(file.parent_path()), 1);
}

TEST(FilesTest, a_failed_write_leaves_nothing_behind) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "taken");
  write_file_atomic(folder.path() / "taken" / "x", "keeps the folder from being replaced");
  EXPECT_THROW(write_file_atomic(folder.path() / "taken", "text"), Error);
  EXPECT_EQ(entries(folder.path()), 1);
  EXPECT_THROW(write_file_atomic("/dev/full/x", "text"), Error);
}

TEST(FilesTest, linking_makes_equal_bytes_and_replaces) {
  const TemporaryFolder folder;
  write_file_atomic(folder.path() / "from", "bytes");
  write_file_atomic(folder.path() / "to", "old");
  link_file_atomic(folder.path() / "from", folder.path() / "to");
  EXPECT_EQ(read_text_file(folder.path() / "to"), "bytes");
  EXPECT_EQ(entries(folder.path()), 2);
  EXPECT_THROW(link_file_atomic(folder.path() / "none", folder.path() / "to"), Error);
  EXPECT_EQ(read_text_file(folder.path() / "to"), "bytes");
}

TEST(FilesTest, every_name_the_system_takes_can_be_written) {
  const TemporaryFolder folder;
  const std::string longest(255, 'n'), too_long(256, 'n');
  write_file_atomic(folder.path() / longest, "one");
  write_file_atomic(folder.path() / "from", "two");
  link_file_atomic(folder.path() / "from", folder.path() / longest);
  EXPECT_EQ(read_text_file(folder.path() / longest), "two");
  EXPECT_THROW(write_file_atomic(folder.path() / too_long, "one"), Error);
  EXPECT_THROW(link_file_atomic(folder.path() / "from", folder.path() / too_long), Error);
  EXPECT_EQ(entries(folder.path()), 2);
}

TEST(FilesTest, what_a_disk_refuses_to_all_names_is_told_apart) {
  for (const int error : {ENOSPC, EDQUOT, EROFS, EIO})
    EXPECT_THROW(fail_system("name", "write", error), DiskFailed);
  for (const int error : {ENAMETOOLONG, EACCES, EPERM, ELOOP, EFBIG, EISDIR, ENOTDIR}) {
    try {
      fail_system("name", "write", error);
    } catch (const DiskFailed&) {
      FAIL() << error;
    } catch (const Error&) {
    }
  }
}

TEST(FilesTest, what_is_written_to_a_linked_file_does_not_reach_the_other) {
  const TemporaryFolder folder;
  const fs::path from = folder.path() / "from", to = folder.path() / "to";
  write_file_atomic(from, "bytes");
  // Twice: over a hard link that was made writable too.
  for (int time = 0; time < 2; ++time) {
    link_file_atomic(from, to);
    EXPECT_EQ(may_write(to) && fs::equivalent(from, to), false);
    std::ofstream(to) << "other";  // fails where the file is a hard link: root gets a copy
    EXPECT_EQ(read_text_file(from), "bytes");
    fs::permissions(from, fs::perms::owner_write, fs::perm_options::add);
  }
}

TEST(FilesTest, a_hard_link_of_before_becomes_a_file_that_is_safe_to_edit) {
  const TemporaryFolder folder;
  const fs::path from = folder.path() / "from", to = folder.path() / "to";
  write_file_atomic(from, "bytes");
  fs::create_hard_link(from, to);
  ASSERT_TRUE(may_write(to));
  link_file_atomic(from, to);
  EXPECT_EQ(may_write(to) && fs::equivalent(from, to), false);
  EXPECT_EQ(read_text_file(to), "bytes");
}

TEST(FilesTest, a_copy_shares_nothing) {
  const TemporaryFolder folder;
  const fs::path from = folder.path() / "from", to = folder.path() / "to";
  write_file_atomic(from, "bytes");
  remove_write_permission(from);
  copy_file_atomic(from, to);
  EXPECT_FALSE(fs::equivalent(from, to));
  EXPECT_NE(fs::status(to).permissions() & fs::perms::owner_write, fs::perms::none);
}

TEST(FilesTest, reading_tells_the_path_and_the_reason) {
  try {
    read_text_file("/nonexistent/file");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io);
    EXPECT_STREQ(error.what(), "/nonexistent/file: cannot open: No such file or directory");
  }
}

/// Names in a folder, hidden ones too.
std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.insert(entry.path().filename());
  return names;
}

TEST(FileBatchTest, replaces_all_at_its_commit_and_not_before) {
  const TemporaryFolder folder;
  write_file_atomic(folder.path() / "a", "old");
  write_file_atomic(folder.path() / "from", "linked");
  FileBatch batch;
  batch.write(folder.path() / "a", bytes_of(std::string_view("one")));
  batch.write(folder.path() / "sub/b", bytes_of(std::string_view("two")));
  batch.link(folder.path() / "from", folder.path() / "sub/c");
  batch.copy(folder.path() / "from", folder.path() / "d");
  EXPECT_EQ(read_text_file(folder.path() / "a"), "old");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "d"));
  batch.commit();
  EXPECT_EQ(read_text_file(folder.path() / "a"), "one");
  EXPECT_EQ(read_text_file(folder.path() / "sub/b"), "two");
  EXPECT_EQ(read_text_file(folder.path() / "sub/c"), "linked");
  EXPECT_EQ(read_text_file(folder.path() / "d"), "linked");
  EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"a", "d", "from", "sub"}));
  EXPECT_EQ(names_in(folder.path() / "sub"), (std::set<std::string>{"b", "c"}));
}

TEST(FileBatchTest, leaves_nothing_of_what_is_not_committed) {
  const TemporaryFolder folder;
  {
    FileBatch batch;
    batch.write(folder.path() / "a", bytes_of(std::string_view("one")));
    batch.write(folder.path() / "b", bytes_of(std::string_view("two")));
  }
  EXPECT_EQ(names_in(folder.path()), std::set<std::string>{});
}

TEST(FileBatchTest, a_name_that_is_refused_leaves_whole_files_and_no_temporaries) {
  const TemporaryFolder folder;
  write_file_atomic(folder.path() / "taken/x", "keeps the folder from being replaced");
  FileBatch batch;
  batch.write(folder.path() / "a", bytes_of(std::string_view("one")));
  batch.write(folder.path() / "taken", bytes_of(std::string_view("two")));
  batch.write(folder.path() / "z", bytes_of(std::string_view("three")));
  EXPECT_THROW(batch.commit(), Error);
  EXPECT_EQ(read_text_file(folder.path() / "a"), "one");
  EXPECT_TRUE(std::filesystem::is_directory(folder.path() / "taken"));
}

TEST(FileBatchTest, temporaries_go_with_a_batch_that_failed) {
  const TemporaryFolder folder;
  write_file_atomic(folder.path() / "taken/x", "keeps the folder from being replaced");
  {
    FileBatch batch;
    batch.write(folder.path() / "taken", bytes_of(std::string_view("two")));
    batch.write(folder.path() / "z", bytes_of(std::string_view("three")));
    EXPECT_THROW(batch.commit(), Error);
  }
  EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"taken"});
}

}  // namespace
}  // namespace ds
