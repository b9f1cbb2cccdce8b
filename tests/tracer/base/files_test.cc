// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/files.h"

#include "tracer/base/disk_error.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>
#include <iterator>

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

}  // namespace
}  // namespace ds
