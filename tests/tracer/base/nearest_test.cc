// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/nearest.h"

#include <gtest/gtest.h>

#include <array>

namespace ds {
namespace {

TEST(EditDistance, CountsSlips) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("glass", "glass"), 0u);
  EXPECT_EQ(edit_distance("glas", "glass"), 1u);
  EXPECT_EQ(edit_distance("galss", "glass"), 1u);  // swapped
  EXPECT_EQ(edit_distance("bulid", "build"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("abcd", "badc"), 2u);
}

TEST(Nearest, IsWhatWasMeant) {
  constexpr std::array<std::string_view, 6> words = {"build", "plan",   "status",
                                                     "log",   "models", "devices"};
  EXPECT_EQ(nearest("bulid", words), "build");
  EXPECT_EQ(nearest("Build", words), "build");
  EXPECT_EQ(nearest("stats", words), "status");
  EXPECT_EQ(nearest("dev", words), "devices");  // the only one that it begins
  EXPECT_EQ(nearest("model", words), "models");
  EXPECT_EQ(nearest("lgo", words), "log");
  EXPECT_EQ(nearest("render", words), "");
  EXPECT_EQ(nearest("x", words), "");
  EXPECT_EQ(nearest("", words), "");
  EXPECT_EQ(nearest("pl", words), "");
}

TEST(Nearest, OneLetterIsNotMeantToBeAnother) {
  constexpr std::array<std::string_view, 2> words = {"n", "k"};
  EXPECT_EQ(nearest("m", words), "");
  EXPECT_EQ(nearest("N", words), "n");
}

TEST(KnownWords, ListsWhatThereIsWhereNothingLooksLikeIt) {
  constexpr std::array<std::string_view, 2> words = {"point", "spot"};
  EXPECT_EQ(known_words("piont", words), ", did you mean point?");
  EXPECT_EQ(known_words("area", words), "; there are point, spot");
  EXPECT_EQ(known_words("area", std::span(words).first(1)), "; there is point");
  EXPECT_EQ(known_words("area", {}), "");
  EXPECT_EQ(did_you_mean("area", words), "");
}

}  // namespace
}  // namespace ds
