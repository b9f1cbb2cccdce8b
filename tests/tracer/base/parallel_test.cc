// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/parallel.h"

#include "tracer/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

namespace ds {
namespace {

using Ranges = std::vector<std::pair<std::size_t, std::size_t>>;

Ranges ranges_of(std::size_t count, std::size_t least) {
  std::mutex mutex;
  Ranges ranges;
  parallel_ranges(count, least, [&](std::size_t begin, std::size_t end) {
    const std::lock_guard lock(mutex);
    ranges.emplace_back(begin, end);
  });
  std::sort(ranges.begin(), ranges.end());
  return ranges;
}

TEST(ParallelRanges, CoverEveryNumberOnce) {
  for (const std::size_t count : {1U, 2U, 7U, 64U, 1001U}) {
    std::size_t next = 0;
    for (const auto& [begin, end] : ranges_of(count, 1)) {
      EXPECT_EQ(begin, next) << count;
      EXPECT_GT(end, begin);
      next = end;
    }
    EXPECT_EQ(next, count);
  }
}

TEST(ParallelRanges, LittleWorkIsOneRange) {
  EXPECT_EQ(ranges_of(15, 8), (Ranges{{0, 15}}));
  EXPECT_EQ(ranges_of(3, 8), (Ranges{{0, 3}}));
  EXPECT_EQ(ranges_of(0, 8), (Ranges{{0, 0}}));
}

TEST(ParallelRanges, ThrowWhatTheFirstFailureThrewOnceAllHaveEnded) {
  std::atomic<int> ended{0};
  const std::size_t all = ranges_of(1000, 1).size();
  try {
    parallel_ranges(1000, 1, [&](std::size_t begin, std::size_t) {
      ++ended;
      fail(ErrorKind::io, "from {}", begin);
    });
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("from 0"));
  }
  EXPECT_EQ(static_cast<std::size_t>(ended), all);
}

}  // namespace
}  // namespace ds
