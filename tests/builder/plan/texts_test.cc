// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/texts.h"

#include "tracer/base/canonical.h"

#include <gtest/gtest.h>

namespace ds {
namespace {

std::vector<std::string> diff(const std::string& before, const std::string& after) {
  std::vector<std::string> lines;
  for (const PropertyChange& change : diff_texts(before, after))
    lines.push_back(to_string(change));
  return lines;
}

using Lines = std::vector<std::string>;

TEST(DiffTexts, NamesWhatChangedWithNumbersForPeople) {
  EXPECT_EQ(diff("kd = 0x1p-1 0x1p-2\nn = 4\n", "kd = 0x1p-1 0x1.8p+0\nn = 4\n"),
            Lines{"kd: 0.5 0.25 -> 0.5 1.5"});
  EXPECT_EQ(diff("a = 1\n", "b = 2\n"), (Lines{"b: added 2", "a: removed (was 1)"}));
  EXPECT_EQ(diff("a = 1\n", "a = 1\n"), Lines{});
}

TEST(DiffTexts, PairsRepeatedNamesByPosition) {
  EXPECT_EQ(diff("a = 1\na = 2\n", "a = 1\na = 3\n"), Lines{"a #2: 2 -> 3"});
}

TEST(ReadableValue, LeavesWhatIsNoHexFloat) {
  EXPECT_EQ(readable_value("0x1.99999ap-4"), "0.1");
  EXPECT_EQ(readable_value("0x1.999999999999ap-4"), "0.1");
  EXPECT_EQ(readable_value("-0x1p+0 12 inf"), "-1 12 inf");
  EXPECT_EQ(readable_value("0xyp and 0x"), "0xyp and 0x");
  EXPECT_EQ(readable_value(""), "");
}

TEST(TextSet, FoldsLongValuesAndUnfoldsThemAgain) {
  const std::string program(1000, 'x');
  CanonicalText text;
  text.add("seed", 3);
  text.add("program", program);
  TextSet texts;
  const Hash128 hash = texts.add(text.text());
  ASSERT_NE(texts.find(hash), nullptr);
  EXPECT_LT(texts.find(hash)->size(), 100U);
  const auto find = [&](Hash128 inner) -> std::optional<std::string> {
    const std::string* found = texts.find(inner);
    return found != nullptr ? std::optional(*found) : std::nullopt;
  };
  EXPECT_EQ(unfold(*texts.find(hash), find), text.text());
  std::size_t visited = 0;
  texts.visit(hash, [&](Hash128 key, const std::string& body) {
    EXPECT_EQ(key, hash_text(body));
    ++visited;
  });
  EXPECT_EQ(visited, 2U);
}

TEST(TextSet, HashDependsOnEveryByteOfALongValue) {
  TextSet texts;
  const std::string head = "program = " + std::string(500, 'x');
  EXPECT_NE(texts.add(head + "a\n"), texts.add(head + "b\n"));
  EXPECT_EQ(texts.add(head + "a\n"), texts.add(head + "a\n"));
}

TEST(DiffLines, ShowsTheEditedLinesOfAProgram) {
  EXPECT_EQ(diff_lines("a\\nb\\nc", "a\\nB\\nc", 10), (Lines{"- b", "+ B"}));
  EXPECT_EQ(diff_lines("a\\nc", "a\\nb\\nc", 10), Lines{"+ b"});
  EXPECT_EQ(diff_lines("a", "a", 10), Lines{});
  EXPECT_EQ(diff_lines("a\\nb", "c\\nd", 1), (Lines{"- a", "... 3 more lines"}));
}

}  // namespace
}  // namespace ds
