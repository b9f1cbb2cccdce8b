// SPDX-License-Identifier: Apache-2.0
#include "manifests/sources.h"

#include <gtest/gtest.h>

namespace ds {
namespace {

TEST(Sources, HaveTheFirstAddressOfTheirText) {
  EXPECT_EQ(first_url("The Princeton Shape Benchmark (https://shape.cs.princeton.edu/benchmark)."),
            "https://shape.cs.princeton.edu/benchmark");
  EXPECT_EQ(first_url("see http://a.org/x?y=1&z=(2), or https://b.org"), "http://a.org/x?y=1&z=(2");
  EXPECT_EQ(first_url("<https://a.org/>\r\n"), "https://a.org/");
  EXPECT_EQ(first_url("https://"), "");
  EXPECT_EQ(first_url("made by hand, ftp://a.org"), "");
  EXPECT_EQ(first_url(""), "");
}

TEST(Sources, HoldEachTextOnce) {
  const std::vector<SourceRecord> sources = group_sources({{"models/b.off", "from https://b.org\n"},
                                                           {"models/a.off", "from https://b.org\n"},
                                                           {"environments/hall", "by hand"}});
  ASSERT_EQ(sources.size(), 2U);
  EXPECT_EQ(sources[0], (SourceRecord{"", "by hand", {"environments/hall"}}));
  EXPECT_EQ(
      sources[1],
      (SourceRecord{"https://b.org", "from https://b.org\n", {"models/a.off", "models/b.off"}}));
}

}  // namespace
}  // namespace ds
