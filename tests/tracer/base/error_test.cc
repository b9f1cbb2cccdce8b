// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"

#include <gtest/gtest.h>

namespace ds {
namespace {

TEST(ErrorTest, exit_codes_tell_the_users_fault_from_the_rest) {
  EXPECT_EQ(exit_code(ErrorKind::usage), 2);
  EXPECT_EQ(exit_code(ErrorKind::recipe), 2);
  EXPECT_EQ(exit_code(ErrorKind::asset), 1);
  EXPECT_EQ(exit_code(ErrorKind::io), 1);
}

TEST(DiagnosticsTest, reports_all_in_one_error) {
  Diagnostics found(ErrorKind::recipe);
  found.throw_if_any();
  found.add({"a.toml", 3, 7}, "wanted {}, got {}", 1, 2);
  found.add({"a.toml", 9, 0}, "unknown key");
  try {
    found.throw_if_any();
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::recipe);
    EXPECT_STREQ(error.what(), "a.toml:3:7: wanted 1, got 2\na.toml:9: unknown key");
  }
}

TEST(AssertDeathTest, is_on_in_every_build) {
  EXPECT_DEATH(DS_ASSERT(1 + 1 == 3), "1 \\+ 1 == 3");
}

}  // namespace
}  // namespace ds
