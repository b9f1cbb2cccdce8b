// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/text_form.h"

#include "tracer/base/canonical.h"

#include <gtest/gtest.h>

namespace ds {
namespace {

std::string text_of(const char* seed, const char* last) {
  CanonicalText text;
  text.add("other.seed", "1");
  text.add("seed", seed);
  text.add("text", "seed = 3");
  text.add("last", last);
  return text.text();
}

TEST(TextForm, FillsTheEntriesOfTheseNamesAndNoOthers) {
  TextForm form(text_of("17", "x"), {"seed", "last"});
  EXPECT_EQ(form.fill({"4", "yy"}), text_of("4", "yy"));
  EXPECT_EQ(form.fill({"", ""}), text_of("", ""));
  EXPECT_EQ(form.hash({"123456", "z"}), hash_text(text_of("123456", "z")));
}

TEST(TextForm, FillsTheFirstEntry) {
  TextForm form("a = 1\nb = 2\n", {"a"});
  EXPECT_EQ(form.fill({"3"}), "a = 3\nb = 2\n");
}

TEST(TextFormDeathTest, HasNoEntryThatTheTextLacks) {
  EXPECT_DEATH(TextForm("a = 1\nb = 2\n", {"c"}), "");
}

}  // namespace
}  // namespace ds
