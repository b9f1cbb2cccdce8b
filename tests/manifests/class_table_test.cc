// SPDX-License-Identifier: Apache-2.0
#include "manifests/class_table.h"

#include "tracer/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ds {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> rows(std::string_view text) {
  std::vector<std::string> rows;
  for (const LabelledModel& model : parse_class_table(text, "c.csv"))
    rows.push_back(model.model + "|" + model.label.class_path + "|" + model.label.split);
  return rows;
}

std::string findings(std::string_view text) {
  try {
    parse_class_table(text, "c.csv");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::asset);
    return error.what();
  }
  ADD_FAILURE() << "read without an error";
  return "";
}

TEST(ClassTable, ReadsColumnsInAnyOrderAndPassesOverOthers) {
  EXPECT_THAT(rows("name,class\nmug.ply,thing/mug\ncar,\n"),
              ElementsAre("mug.ply|thing/mug|", "car||"));
  EXPECT_THAT(rows("id,split,class,name\n1,train,a,x\n2,,b/c,y\n3,test,a,z"),
              ElementsAre("x|a|train", "y|b/c|", "z|a|test"));
  EXPECT_THAT(rows("name,class,split\n"), ElementsAre());
}

TEST(ClassTable, TakesWhatPeopleCallSplits) {
  EXPECT_THAT(rows("name,class,split\na,c,val\nb,c,Validation\nd,c,dev\ne,c,valid\nf,c,training\n"
                   "g,c,TRAIN\nh,c,testing\ni,c,eval\nj,c,evaluation\n"),
              ElementsAre("a|c|val", "b|c|val", "d|c|val", "e|c|val", "f|c|train", "g|c|train",
                          "h|c|test", "i|c|test", "j|c|test"));
}

TEST(ClassTable, TakesQuotesLineEndsEmptyLinesAndAByteOrderMark) {
  EXPECT_THAT(
      rows("\xef\xbb\xbf\"name\",class\r\n\r\n\"a \"\"b\"\", c\",\"d\"\r\"two\nlines\",e\n\n"),
      ElementsAre("a \"b\", c|d|", "two\nlines|e|"));
}

TEST(ClassTable, SaysAllThatIsWrongWithItsLine) {
  const std::string found = findings(
      "name,class,split\n,a,train\nb,a//c,\n\"c\n\",..,\nd,a\ne,a,vale\nb,0,test\nf,/a,\ng,a/,\n");
  for (const char* wanted :
       {"c.csv:2: the name is empty", "c.csv:3: a class must be names with / between",
        "c.csv:4: a class must be names", "c.csv:6: must have 3 fields as the first line, found 2",
        "c.csv:7: split must be train, val, test or empty, got \"vale\"",
        "c.csv:8: model b stands twice, first in line 3", "c.csv:8: a class must be names",
        "c.csv:9: a class must be names", "c.csv:10: a class must be names"})
    EXPECT_THAT(found, HasSubstr(wanted));
  // What models are refused for, which no list of a class a line can hold.
  for (const char* wanted :
       {"c.csv:2: a class must be names with / between, none of 0 . .., without "
        "control characters, got \"a\\nb\"",
        "c.csv:4: a class must be", "c.csv:5: a class must be"})
    EXPECT_THAT(findings("name,class\na,\"a\nb\"\nb,x/y\x01\nc,x\ty\n"), HasSubstr(wanted));
  EXPECT_EQ(findings(""), "c.csv: must name the columns name and class, found an empty file");
  EXPECT_EQ(findings("name;class\na;b\n"),
            "c.csv:1: must name the columns name and class, and may split, found \"name;class\"");
  EXPECT_THAT(findings("name,class,name\n"), HasSubstr("c.csv:1: has two columns name"));
  EXPECT_THAT(findings("name,class\n\"a,b\n"), HasSubstr("c.csv:2: a quote is not closed"));
  EXPECT_THAT(findings("\xff\xfen"), HasSubstr("UTF-16"));
}

TEST(ClassTable, BlanksAroundNamesAreNoneOfAClass) {
  EXPECT_THAT(rows("name,class\na,chair \nb, a / b c\t/d\nc, \n"),
              ElementsAre("a|chair|", "b|a/b c/d|", "c||"));
  EXPECT_THAT(findings("name,class\na,a/ /b\n"), HasSubstr("c.csv:2: a class must be"));
}

TEST(Labels, OfAListKnowTheirClassesAndSplits) {
  const Labels labels(parse_class_table("name,class,split\nb,x/y/z,\na,x/w,train\n", "c.csv"));
  EXPECT_EQ(labels.find("a.off"), (ModelLabel{"x/w", "train"}));
  EXPECT_EQ(labels.find("c.off"), std::nullopt);
  EXPECT_TRUE(labels.has_splits());
  EXPECT_THAT(labels.class_paths(), ElementsAre("x", "x/w", "x/y", "x/y/z"));
  EXPECT_FALSE(Labels(parse_class_table("name,class\nb,x\n", "c.csv")).has_splits());
}

}  // namespace
}  // namespace ds
