// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/value.h"

#include <gtest/gtest.h>

namespace ds {
namespace {

/// The tree as one line of TOML, or the findings.
std::string parsed(std::string_view text, const std::vector<std::string>& overrides = {}) {
  Diagnostics diagnostics(ErrorKind::recipe);
  RecipeValue tree{parse_recipe_text(text, "r.toml", diagnostics), {}, false};
  for (const std::string& assignment : overrides)
    apply_override(assignment, *tree.table(), diagnostics);
  std::string all = diagnostics.empty() ? to_toml(tree) : "";
  for (const std::string& line : diagnostics.lines())
    all += (all.empty() ? "" : "\n") + line;
  return all;
}

TEST(RecipeValue, HasOneSpelling) {
  EXPECT_EQ(
      parsed("b = 0x10\na = 'x\"\\'\n[s]\nf = 1e2\ng = [1, 2.5, [true]]\nh = {z = inf, y = -nan}"),
      "{a = \"x\\\"\\\\\", b = 16, s = {f = 100.0, g = [1, 2.5, [true]], h = {y = nan, z = inf}}}");
}

TEST(RecipeValue, TakesAnyLineEndAndAByteOrderMark) {
  for (const std::string end : {"\n", "\r\n", "\r"})
    EXPECT_EQ(parsed("\xef\xbb\xbf"
                     "# a remark" +
                     end + "[s]" + end + end + "a.b = 1" + end + "c.d = 2"),
              "{s = {a = {b = 1}, c = {d = 2}}}");
  EXPECT_TRUE(parsed("a = 1\rb = = 2\r").starts_with("r.toml:2:5: must be TOML: "));
  EXPECT_EQ(parsed("\xff\xfe"), "r.toml: must be UTF-8, found UTF-16");
  std::string dotted = "[a]";
  for (int i = 0; i < 40; ++i)
    dotted += fmt::format("\rx{}.y = 1", i);
  EXPECT_EQ(parsed(dotted).substr(0, 5), "{a = ");
}

TEST(RecipeValue, KnowsLineAndColumnOfValuesElementsAndSections) {
  Diagnostics diagnostics(ErrorKind::recipe);
  const auto tree = parse_recipe_text("[camera]\nfov_deg = 49\nviews = [1,\n  2]\n[outputs]\n",
                                      "r.toml", diagnostics);
  const auto& camera = *tree.at("camera").table();
  EXPECT_EQ(to_string(camera.at("fov_deg").place), "r.toml:2:11");
  EXPECT_EQ(to_string((*camera.at("views").array())[1].place), "r.toml:4:3");
  EXPECT_EQ(to_string(tree.at("outputs").place), "r.toml:5:2");
}

TEST(RecipeValue, ReportsTextThatIsNoToml) {
  EXPECT_TRUE(parsed("a = 1\nb = = 2\n").starts_with("r.toml:2:5: must be TOML: "))
      << parsed("a = 1\nb = = 2\n");
  EXPECT_EQ(parsed("a = 1\nb = 2024-01-01\n"),
            "r.toml:2:5: no key takes a date or time; a string wants quotes");
}

TEST(RecipeValue, RefusesNestingThatWouldExhaustTheStack) {
  std::string dotted = "a";
  for (int i = 0; i < 100000; ++i)
    dotted += ".a";
  EXPECT_EQ(parsed(dotted + " = 1\n"), "r.toml: a key must have at most 32 parts, got 100000");
  EXPECT_EQ(parsed("[" + dotted + "]\n"), "r.toml: a key must have at most 32 parts, got 100000");
  EXPECT_TRUE(parsed("a = " + std::string(100000, '[')).starts_with("r.toml:1:"));
  EXPECT_EQ(parsed("# " + std::string(500, '.') + "\na = 1"), "{a = 1}");
}

TEST(RecipeOverride, IsATomlValueOrElseAString) {
  EXPECT_EQ(parsed("", {"s.a=1", "s.b=1.5", "s.c=true", "s.d=[\"x\"]", "s.e={k = 1}"}),
            "{s = {a = 1, b = 1.5, c = true, d = [\"x\"], e = {k = 1}}}");
  EXPECT_EQ(parsed("", {"a=../shared/models", "b=", "c=\"\"", "d=x=y", "e=1 2"}),
            "{a = \"../shared/models\", b = \"\", c = \"\", d = \"x=y\", e = \"1 2\"}");
}

TEST(RecipeOverride, CannotSmuggleInAnotherKey) {
  EXPECT_EQ(parsed("", {"a=1\nb = 2"}), "{a = \"1\\u000ab = 2\"}");
}

TEST(RecipeOverride, ReplacesAndMakesSections) {
  EXPECT_EQ(parsed("[s]\na = 1\nb = 2\n", {"s.a=3", "t.u.v=4"}),
            "{s = {a = 3, b = 2}, t = {u = {v = 4}}}");
  EXPECT_EQ(parsed("[s]\na = 1\n", {"s.a.x=1"}), "{s = {a = {x = 1}}}");
  EXPECT_EQ(parsed("", {"s.a=1", "s.a=2"}), "{s = {a = 2}}");
}

TEST(RecipeOverride, HasItsOwnPlace) {
  Diagnostics diagnostics(ErrorKind::recipe);
  RecipeValue::Table tree;
  apply_override("s.a=[1]", tree, diagnostics);
  const RecipeValue& value = tree.at("s").table()->at("a");
  EXPECT_TRUE(value.from_set);
  EXPECT_EQ(to_string(value.place), "--set s.a");
  EXPECT_EQ(to_string((*value.array())[0].place), "--set s.a");
}

TEST(RecipeOverride, WantsAKeyAndAValue) {
  EXPECT_EQ(parsed("", {"s.a", "=1", "s..a=1"}),
            "--set: wants section.key=value, got \"s.a\"\n"
            "--set: wants section.key=value, got \"=1\"\n"
            "--set: wants section.key=value, got \"s..a=1\"");
}

}  // namespace
}  // namespace ds
