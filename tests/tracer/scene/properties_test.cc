// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/properties.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ds {
namespace {

using ::testing::ElementsAre;

// What LuxCore 2.11's Properties.SetFromString makes of the same lines, where it takes them.
struct Line {
  const char* text;
  const char* name;
  std::vector<std::string> values;
};

class PropertySyntax : public ::testing::TestWithParam<Line> {};

TEST_P(PropertySyntax, ReadsAsLuxCore) {
  Diagnostics diagnostics(ErrorKind::asset);
  const PropertySet set = PropertySet::parse(GetParam().text, "a.scn", diagnostics);
  EXPECT_TRUE(diagnostics.empty());
  const Property* property = set.find(GetParam().name);
  ASSERT_NE(property, nullptr);
  EXPECT_EQ(property->values, GetParam().values);
}

INSTANTIATE_TEST_SUITE_P(
    Lines, PropertySyntax,
    ::testing::Values(Line{"a.b = \"x y\" z", "a.b", {"x y", "z"}},
                      Line{"a.e = v = w", "a.e", {"v", "=", "w"}},
                      Line{"  a.f = 1\r", "a.f", {"1"}}, Line{"a.g = {[QUJD]}", "a.g", {"QUJD"}},
                      Line{"a.h = 1 # not a comment", "a.h", {"1", "#", "not", "a", "comment"}},
                      Line{"a.i = foo\"bar baz\"", "a.i", {"foo\"bar", "baz\""}},
                      Line{"a.j\t=\t1\t2", "a.j", {"1", "2"}},
                      Line{"a.l = 'single \"inside\"' 2", "a.l", {"single \"inside\"", "2"}},
                      Line{"a.m = \"x\"y", "a.m", {"x", "y"}},
                      Line{"a.o = C:\\x\\y", "a.o", {"C:\\x\\y"}},
                      Line{"a.p = \"\"", "a.p", {""}}));

TEST(Properties, CommentsAndBlankLinesAreSkipped) {
  Diagnostics diagnostics(ErrorKind::asset);
  const PropertySet set =
      PropertySet::parse("# a = 1\n\n   \t\n  # b = 2\nc = 3", "a.scn", diagnostics);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_EQ(set.find("a"), nullptr);
  EXPECT_EQ(set.find("b"), nullptr);
  ASSERT_NE(set.find("c"), nullptr);
  EXPECT_EQ(set.find("c")->place.line, 5);
}

TEST(Properties, AnyLineEndAndAByteOrderMarkAreRead) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    Diagnostics diagnostics(ErrorKind::asset);
    const PropertySet set = PropertySet::parse(
        "\xef\xbb\xbf"
        "a.b = 1" +
            end + end + "a.c = 2 3" + end + "a.d = \"x\"",
        "a.mat", diagnostics);
    EXPECT_TRUE(diagnostics.empty());
    ASSERT_NE(set.find("a.b"), nullptr);
    ASSERT_NE(set.find("a.d"), nullptr);
    EXPECT_THAT(set.find("a.c")->values, ElementsAre("2", "3"));
    EXPECT_EQ(set.find("a.d")->place.line, 4);
    EXPECT_THAT(set.find("a.d")->values, ElementsAre("x"));
  }
}

TEST(Properties, Utf16IsRefusedByName) {
  for (const char* text : {"\xff\xfe"
                           "a\n",
                           "\xfe\xff"
                           "a\n"}) {
    Diagnostics diagnostics(ErrorKind::asset);
    PropertySet::parse(text, "a.mat", diagnostics);
    EXPECT_THAT(diagnostics.lines(), ElementsAre("a.mat: must be UTF-8, found UTF-16"));
  }
}

TEST(Properties, ALaterLineReplacesTheValueAndKeepsThePosition) {
  Diagnostics diagnostics(ErrorKind::asset);
  const PropertySet set =
      PropertySet::parse("t.a.x = 1\nt.b.x = 2\nt.a.x = 3 4\n", "a.scn", diagnostics);
  EXPECT_THAT(set.find("t.a.x")->values, ElementsAre("3", "4"));
  EXPECT_EQ(set.find("t.a.x")->place.line, 3);
  EXPECT_THAT(set.names_below("t"), ElementsAre("a", "b"));
}

TEST(Properties, EverySyntaxErrorIsReportedWithItsLine) {
  Diagnostics diagnostics(ErrorKind::asset);
  PropertySet::parse("noequals\na.k = \"unclosed\na.l =\n= 3\na.b = {[QUJD\nok = 1\n", "a.scn",
                     diagnostics);
  EXPECT_THAT(
      diagnostics.lines(),
      ElementsAre("a.scn:1: wanted \"name = values\", found \"noequals\"",
                  "a.scn:2: a.k: wanted a closing quote, found the end of the line",
                  "a.scn:3: a.l has no value",
                  "a.scn:4: wanted a property name before \"=\", found none",
                  "a.scn:5: a.b: wanted \"]}\" at the end of a blob, found the end of the line"));
}

TEST(Properties, UnusedOnesAreKnown) {
  Diagnostics diagnostics(ErrorKind::asset);
  PropertySet set =
      PropertySet::parse("a.b = 1\na.b.c = 2\na.bc = 3\nd = 4\n", "a.scn", diagnostics);
  EXPECT_NE(set.use("d"), nullptr);
  set.use_all("a.b");
  ASSERT_EQ(set.unused().size(), 1u);
  EXPECT_EQ(set.unused()[0]->name, "a.bc");
}

// What LuxCore 2.11's Properties does: the last line counts, in the first one's place.
TEST(Properties, TheLastOfANameCountsAndIsToldOf) {
  Diagnostics diagnostics(ErrorKind::asset);
  const PropertySet set =
      PropertySet::parse("a.x = 1\na.y = 2\na.x = 3\n\na.x = 4\n", "a.scn", diagnostics);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_THAT(set.find("a.x")->values, ElementsAre("4"));
  EXPECT_THAT(set.names_below("a"), ElementsAre("x", "y"));
  ASSERT_EQ(set.repeated().size(), 1);
  EXPECT_EQ(set.repeated()[0].name, "a.x");
  EXPECT_EQ(set.repeated()[0].first.line, 1);
  EXPECT_EQ(set.repeated()[0].last.line, 5);
}

}  // namespace
}  // namespace ds
