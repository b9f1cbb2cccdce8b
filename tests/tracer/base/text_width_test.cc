// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/text_width.h"

#include <gtest/gtest.h>

namespace ds {
namespace {

TEST(TextWidthTest, columns_are_what_a_terminal_shows) {
  EXPECT_EQ(columns_of(""), 0);
  EXPECT_EQ(columns_of("human.ply/0"), 11);
  EXPECT_EQ(columns_of("M\u00f6bel"), 5);
  EXPECT_EQ(columns_of("Mo\u0308bel"), 5);         // the dots are a character of their own
  EXPECT_EQ(columns_of("\u6905\u5b50"), 4);        // East Asian
  EXPECT_EQ(columns_of("\uff76\uff9e"), 2);        // half width
  EXPECT_EQ(columns_of("\U0001f680"), 2);          // a rocket
  EXPECT_EQ(columns_of("a\u200bb"), 2);            // nothing between them
  EXPECT_EQ(columns_of("\u0915\u094d\u0937"), 2);  // a conjunct, its virama takes none
  EXPECT_EQ(columns_of("\ud55c\uae00"), 4);        // Hangul
  EXPECT_EQ(columns_of("\xff\xc3(\xe6\xa4"), 5);   // no UTF-8: one a byte
  EXPECT_EQ(columns_of("a\tb\x1b"), 2);
}

TEST(TextWidthTest, cutting_tears_no_character) {
  EXPECT_EQ(cut_to_columns("abcdef", 4), "abcd");
  EXPECT_EQ(cut_to_columns("abc", 4), "abc");
  EXPECT_EQ(cut_to_columns("\u6905\u5b50", 3), "\u6905");
  EXPECT_EQ(cut_to_columns("Mo\u0308bel", 2), "Mo\u0308");
  EXPECT_EQ(cut_to_columns("abc", 0), "");
}

TEST(TextWidthTest, shortening_keeps_both_ends) {
  EXPECT_EQ(shorten_to_columns("abcdefghij", 10), "abcdefghij");
  EXPECT_EQ(shorten_to_columns("abcdefghij", 9), "abc...hij");
  EXPECT_EQ(shorten_to_columns("abcdefghij", 8), "abc...ij");
  EXPECT_EQ(shorten_to_columns("abcdefghij", 4), "abcd");
  EXPECT_EQ(shorten_to_columns("abcdefghij", 0), "");
  for (int columns = 0; columns < 30; ++columns) {
    for (const std::string text : {"\u6905\u5b50\u6905\u5b50\u6905\u5b50\u6905\u5b50",
                                   "o\u0308o\u0308o\u0308o\u0308o\u0308o\u0308o\u0308o\u0308"})
      EXPECT_LE(columns_of(shorten_to_columns(text, columns)), columns);
  }
}

}  // namespace
}  // namespace ds
