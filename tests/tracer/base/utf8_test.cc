// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/utf8.h"

#include <gtest/gtest.h>

namespace ds {
namespace {

using namespace std::string_view_literals;

TEST(Utf8Test, well_formed_is_what_the_standard_says) {
  for (const std::string_view good :
       {""sv, "licence"sv, "\0"sv, "M\u00f6bel"sv, "\ud7ff\ue000"sv, "\U00010000\U0010ffff"sv})
    EXPECT_TRUE(is_utf8(good)) << good;
  for (const std::string_view bad :
       {"\xff"sv, "\x80"sv, "\xc0\x80"sv, "\xc3"sv, "\xe0\x80\x80"sv, "\xed\xa0\x80"sv,
        "\xf0\x80\x80\x80"sv, "\xf4\x90\x80\x80"sv, "\xe2\x82"sv,
        "M\xf6"
        "bel"sv})
    EXPECT_FALSE(is_utf8(bad)) << bad;
}

TEST(Utf8Test, the_line_that_is_none_is_told) {
  const auto finding = [](std::string_view text) {
    Diagnostics diagnostics(ErrorKind::asset);
    const bool is_well_formed = check_utf8(text, "a.cla", diagnostics);
    EXPECT_EQ(is_well_formed, diagnostics.empty());
    return diagnostics.empty() ? "" : diagnostics.lines().front();
  };
  EXPECT_EQ(finding("M\u00f6bel\r\nb"), "");
  EXPECT_EQ(finding("a\r\n\nM\xf6"
                    "bel\n\xff"),
            "a.cla:3: must be UTF-8, found bytes that are none");
  EXPECT_EQ(finding("\xff\xfe"
                    "a"),
            "a.cla: must be UTF-8, found UTF-16");
}

TEST(Utf8Test, text_of_any_encoding_becomes_utf8) {
  EXPECT_EQ(utf8_of("\u00a9 2024"), "\u00a9 2024");
  EXPECT_EQ(utf8_of("\xef\xbb\xbf\u00a9"), "\u00a9");
  EXPECT_EQ(utf8_of("\xa9 M\xfcller"), "\u00a9 M\u00fcller");              // ISO 8859-1
  EXPECT_EQ(utf8_of("\x93quoted\x94 \x80"), "\u201cquoted\u201d \u20ac");  // Windows-1252
  EXPECT_EQ(utf8_of("\xff\xfe\xa9\x00 \x00\x3d\xd8\x80\xde"sv), "\u00a9 \U0001f680");
  EXPECT_EQ(utf8_of("\xfe\xff\x00\xa9\x00 \xd8\x3d\xde\x80"sv), "\u00a9 \U0001f680");
  EXPECT_EQ(utf8_of("\xff\xfe\x3d\xd8z\x00"sv), "\ufffdz");
}

TEST(Utf8Test, every_text_becomes_utf8) {
  for (int first = 0; first < 256; ++first) {
    for (int second = 0; second < 256; ++second) {
      std::string bytes{static_cast<char>(first), static_cast<char>(second)};
      bytes += "\x80\xd8\xff";
      EXPECT_TRUE(is_utf8(utf8_of(bytes)));
    }
  }
}

}  // namespace
}  // namespace ds
