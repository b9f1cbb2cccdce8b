// SPDX-License-Identifier: Apache-2.0
// Files looked at from both ends by two threads: each answer is that of a look by itself.
#include "builder/db/stamps_ahead.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <unistd.h>
#include <vector>

namespace ds {
namespace {

constexpr std::size_t k_files = 3000;

class StampsAheadTest : public testing::Test {
 protected:
  StampsAheadTest() : descriptor_(::open(folder_.path().c_str(), O_PATH | O_DIRECTORY)) {
    for (std::size_t i = 0; i < k_files; ++i) {
      const int file = ::openat(descriptor_, name(i).c_str(), O_WRONLY | O_CREAT, 0600);
      EXPECT_EQ(::write(file, "abc", i % 3), static_cast<ssize_t>(i % 3));
      ::close(file);
      names_.push_back(name(i));
      stamps_.push_back(*stamp_in(descriptor_, names_.back().c_str()));
    }
  }
  ~StampsAheadTest() override { ::close(descriptor_); }
  static std::string name(std::size_t i) { return fmt::format("{}.png", i); }
  StampsAhead::File file(std::size_t i) const {
    return {names_[i].c_str(), i % 100 == 99 ? nullptr : &stamps_[i]};
  }
  /// Every tenth file is another, or gone.
  void change_some() {
    for (std::size_t i = 0; i < k_files; i += 10) {
      ASSERT_EQ(::unlinkat(descriptor_, name(i).c_str(), 0), 0);
      if (i % 20 == 0) continue;
      ::close(::openat(descriptor_, name(i).c_str(), O_WRONLY | O_CREAT, 0600));
    }
  }

  TemporaryFolder folder_;
  int descriptor_;
  std::vector<std::string> names_;
  std::vector<FileStamp> stamps_;
};

TEST_F(StampsAheadTest, NeverTakesAnotherFileForTheOneThatIsKnown) {
  change_some();
  for (int round = 0; round < 20; ++round) {
    StampsAhead ahead(descriptor_, k_files, [this](std::size_t i) { return file(i); });
    for (std::size_t i = 0; i < k_files; ++i) {
      const bool is_known = ahead.is_known(i);
      if (i % 10 == 0 || i % 100 == 99) {
        EXPECT_FALSE(is_known) << i;
      }
    }
  }
}

TEST_F(StampsAheadTest, IsSilentOfFoldersThatCannotBeLookedAt) {
  StampsAhead ahead(-1, k_files, [this](std::size_t i) { return file(i); });
  for (std::size_t i = 0; i < k_files; ++i)
    EXPECT_FALSE(ahead.is_known(i));
}

}  // namespace
}  // namespace ds
