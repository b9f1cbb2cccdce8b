// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_text.h"

#include "tracer/scene/mesh_polygons.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ds {
namespace {

double value_of(std::string_view text) {
  const ParsedNumber parsed = parse_number(text);
  EXPECT_EQ(parsed.size, text.size()) << text;
  return parsed.value;
}

TEST(ParseNumber, ReadsWhatFilesHold) {
  EXPECT_EQ(value_of("0"), 0);
  EXPECT_EQ(value_of("-1.5e3"), -1500);
  EXPECT_EQ(value_of("+.5"), 0.5);
  EXPECT_EQ(value_of("7."), 7);
  EXPECT_EQ(value_of("1E+2"), 100);
  EXPECT_EQ(value_of("0.1"), 0.1);
  EXPECT_TRUE(std::isnan(value_of("nan")));
  EXPECT_TRUE(std::isnan(value_of("-NaN")));
  EXPECT_EQ(value_of("-inf"), -std::numeric_limits<double>::infinity());
}

TEST(ParseNumber, TellsTooLargeFromTooSmall) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(value_of("1e400"), inf);
  EXPECT_EQ(value_of("-1e400"), -inf);
  EXPECT_EQ(value_of("1e99999999999999999999"), inf);
  EXPECT_EQ(value_of("1e-400"), 0);
  EXPECT_TRUE(std::signbit(value_of("-1e-400")));
  EXPECT_EQ(value_of("1e-99999999999999999999"), 0);
  EXPECT_EQ(value_of(std::string(400, '9')), inf);
  EXPECT_EQ(value_of("0." + std::string(400, '0') + "1"), 0);
  EXPECT_EQ(value_of("0." + std::string(400, '0') + "1e800"), inf);
  EXPECT_EQ(value_of("1" + std::string(400, '0') + "e-800"), 0);
}

TEST(ParseNumber, RefusesWhatIsNone) {
  for (const char* text : {"", "+", "-", "x", "+-1", "--1", "e5", "."})
    EXPECT_EQ(parse_number(text).size, 0U) << text;
}

TEST(LineCursor, CountsLinesWhateverEndsThem) {
  LineCursor cursor("f", "1\n\n2\r\n3\r\r4 # 5\n#\n 6", 10, '#');
  for (const auto& [line, value] :
       {std::pair{10U, 1.0}, {12U, 2.0}, {13U, 3.0}, {15U, 4.0}, {17U, 6.0}}) {
    ASSERT_TRUE(cursor.next_line());
    EXPECT_EQ(cursor.line(), line);
    EXPECT_EQ(cursor.number(), value);
    EXPECT_TRUE(cursor.line_done());
  }
  EXPECT_FALSE(cursor.next_line());
  EXPECT_FALSE(cursor.next_line());
}

TEST(LineCursor, GivesIndicesOnlyForWholeNumbersInRange) {
  LineCursor cursor("f", "0 4294967294 7.0 4294967295 -1 1.5 1e99 nan", 1, '\0');
  cursor.next_line();
  const std::uint32_t bad = LineCursor::k_bad_index;
  for (const std::uint32_t wanted : {0U, 4294967294U, 7U, bad, bad, bad, bad, bad}) {
    ASSERT_FALSE(cursor.line_done());
    EXPECT_EQ(cursor.index(), wanted);
  }
}

TEST(LineCursor, ANumberEndsAtABlank) {
  for (const std::string_view text : {"1,2", "1x", "0x10", "1.#INF", "1e", "1-2"}) {
    LineCursor cursor("f", text, 1, '\0');
    cursor.next_line();
    EXPECT_THROW(cursor.number(), Error) << text;
  }
  const std::string_view with_nul("1\0", 2);
  LineCursor cursor("f", with_nul, 1, '\0');
  cursor.next_line();
  EXPECT_THROW(cursor.number(), Error);
}

TEST(Printable, KeepsMessagesOnOneShortLine) {
  EXPECT_EQ(printable("a\nb\x80\x01"), "a?b??");
  EXPECT_EQ(printable(std::string(100, 'a')).size(), 40U);
}

TEST(ToMeshFloat, RoundsOnceAndHasNoNegativeZero) {
  EXPECT_EQ(to_mesh_float(0.1), 0.1F);
  EXPECT_FALSE(std::signbit(to_mesh_float(-0.0)));
  EXPECT_FALSE(std::signbit(to_mesh_float(-1e-300)));
  EXPECT_EQ(to_mesh_float(-1e300), -std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(to_mesh_float(std::nan(""))));
}

TEST(Believable, IsWhatTheBytesCanHold) {
  EXPECT_EQ(believable(4000000000U, 100, 12), 8U);
  EXPECT_EQ(believable(3, 100, 12), 3U);
}

TEST(LineCursor, JoinsLinesWhereTheirEndSaysSo) {
  LineCursor cursor("m", "a 1\\\n2 \\\r\n 3\nb \\ # \\\n4 \\", 1, '#', '\\');
  ASSERT_TRUE(cursor.next_line());
  EXPECT_EQ(cursor.word(), "a");
  for (const double number : {1, 2, 3}) {
    ASSERT_FALSE(cursor.line_done());
    EXPECT_EQ(cursor.number(), number);
  }
  EXPECT_TRUE(cursor.line_done());
  EXPECT_EQ(cursor.line(), 3U);
  ASSERT_TRUE(cursor.next_line());
  EXPECT_EQ(cursor.word(), "b");
  EXPECT_EQ(cursor.word(), "\\") << "not at the line's end";
  EXPECT_TRUE(cursor.line_done()) << "a comment is not continued";
  ASSERT_TRUE(cursor.next_line());
  EXPECT_EQ(cursor.number(), 4);
  EXPECT_TRUE(cursor.line_done());
  EXPECT_FALSE(cursor.next_line());
}

TEST(LineCursor, GivesTheRestOfALineAsItStands) {
  LineCursor cursor("m", "name  a # b\t\r\nnext\n", 1, '#');
  ASSERT_TRUE(cursor.next_line());
  EXPECT_EQ(cursor.word(), "name");
  EXPECT_EQ(cursor.rest_of_line(), "a # b");
  EXPECT_TRUE(cursor.line_done());
  ASSERT_TRUE(cursor.next_line());
  EXPECT_EQ(cursor.word(), "next");
  EXPECT_EQ(cursor.rest_of_line(), "");
}

}  // namespace
}  // namespace ds
