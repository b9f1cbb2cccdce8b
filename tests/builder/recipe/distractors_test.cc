// SPDX-License-Identifier: Apache-2.0
// Which distractors an image is to show, and what moves none of them.
#include "builder/recipe/distractors.h"

#include "tests/builder/recipe_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>

namespace ds {
namespace {

using testing::HasSubstr;

constexpr std::string_view k_section =
    "distractors.dir = \"others\"\ndistractors.count = { integer = [0, 3] }\n"
    "distractors.place_m = { disc = [0.1, 0.3] }\ndistractors.size_m = { uniform = [0.05, 0.1] }\n"
    "distractors.turn = { rotation = \"up\" }\n";

class DistractorsTest : public testing::Test {
 protected:
  using Shown = std::tuple<std::string, std::string, DrawnValues>;

  DistractorsTest() {
    for (const char* name : {"ball.off", "cone.ply", "cube.off"})
      folder_.add(std::string("others/") + name);
  }
  Recipe recipe(std::string_view more = "", const std::vector<std::string>& overrides = {}) const {
    return folder_.read(std::string(k_section) + std::string(more), overrides);
  }
  /// By image and number.
  static std::map<std::string, Shown> shown(const Recipe& recipe) {
    std::map<std::string, Shown> all;
    for (const ImageSpec& image : expand(recipe))
      for (Distractor& one : draw_distractors(image, recipe)) {
        draw_place(one, image, recipe, 0);
        all[image.id + " " + std::to_string(one.number)] = {*one.model.name, *one.material_name,
                                                            one.draws};
      }
    return all;
  }
  /// Of those that both have.
  static std::set<std::string> differing(const std::map<std::string, Shown>& a,
                                         const std::map<std::string, Shown>& b) {
    std::set<std::string> names;
    for (const auto& [name, what] : a)
      if (const auto at = b.find(name); at != b.end() && at->second != what) names.insert(name);
    return names;
  }

  RecipeFolder folder_;
};

TEST_F(DistractorsTest, AreDrawnByTheRuleOfDraws) {
  const Recipe read = recipe();
  ASSERT_EQ(read.distractors.drawn.size(), 3U);
  EXPECT_EQ(read.drawn.size(), 1U);  // their count
  std::set<int> counts;
  for (const ImageSpec& image : expand(read)) {
    const std::vector<Distractor> drawn = draw_distractors(image, read);
    EXPECT_EQ(drawn.size(), static_cast<std::size_t>(image.variables->draws[0][0]));
    counts.insert(static_cast<int>(drawn.size()));
    for (Distractor one : drawn) {
      DrawnFor of{read.seed, *image.model_name, *image.view, 0, 0};
      const auto value = [&](std::size_t i, const char* name) {
        return draw(read.distractors.drawn[i].distribution, distractor_key(one.number, name), of);
      };
      EXPECT_EQ(one.values.distractor_size_m, value(1, "size_m")[0]);
      EXPECT_EQ(one.values.distractor_turn, value(2, "turn"));
      for (const int tries : {0, 5}) {
        draw_place(one, image, read, tries);
        of.attempt = tries;
        const DrawnValue place = value(0, "place_m");
        EXPECT_EQ(one.values.distractor_place_m,
                  (std::array<double, 3>{place[0], place[1], place[2]}));
      }
    }
  }
  EXPECT_EQ(counts, (std::set<int>{0, 1, 2, 3}));
}

TEST_F(DistractorsTest, AreMovedByNothingElse) {
  const auto before = shown(recipe());
  ASSERT_GT(before.size(), 30U);
  // Other keys drawn, other assignments, another order of the file.
  EXPECT_EQ(shown(recipe("camera.fov_deg = { uniform = [40, 60] }\nmaterials.assign = \"cycle\"\n"
                         "camera.lens_radius_m = 0.001\nenvironments.assign = \"random\"\n")),
            before);
  // One model and one view more.
  folder_.add("models/sofa.off");
  EXPECT_TRUE(differing(before, shown(recipe())).empty());
  EXPECT_GT(shown(recipe()).size(), before.size());
  // More of them: those there were stay.
  EXPECT_TRUE(differing(before, shown(recipe("", {"distractors.count=3"}))).empty());
  // Another distribution of one key moves that key alone.
  for (const auto& [name, what] : shown(recipe("", {"distractors.size_m={uniform=[0.1,0.2]}"}))) {
    const auto at = before.find(name);
    if (at == before.end()) continue;
    EXPECT_EQ(std::get<0>(what), std::get<0>(at->second));
    EXPECT_EQ(std::get<2>(what)[0], std::get<2>(at->second)[0]);
    EXPECT_EQ(std::get<2>(what)[2], std::get<2>(at->second)[2]);
  }
}

TEST_F(DistractorsTest, OneCandidateMoreChangesThoseThatThenShowIt) {
  const auto before = shown(recipe());
  folder_.add("others/lamp.off");
  const auto after = shown(recipe());
  const std::set<std::string> changed = differing(before, after);
  EXPECT_FALSE(changed.empty());
  EXPECT_LT(changed.size(), before.size() / 2);
  for (const auto& [name, what] : after)
    EXPECT_EQ(changed.contains(name), std::get<0>(what) == "lamp.off") << name;
}

TEST_F(DistractorsTest, OfTheRecipeAreOfTheImagesOwnSplitAndFold) {
  for (const char* name : {"bus", "cup", "desk", "fork", "hat", "jar"})
    folder_.add(std::string("models/") + name + ".off");
  const Recipe read = recipe("classes.split.test = 0.4\nclasses.split.folds = 2\n",
                             {"distractors.dir=\"{models}\"", "distractors.count=3"});
  std::map<std::string, std::pair<std::string, std::optional<std::uint64_t>>> groups;
  for (const ImageSpec& image : expand(read))
    groups[*image.model_name] = {*image.split, image.fold};
  std::set<std::string> seen;
  for (const ImageSpec& image : expand(read))
    for (const Distractor& one : draw_distractors(image, read)) {
      EXPECT_EQ(groups.at(*one.model.name), groups.at(*image.model_name)) << image.id;
      seen.insert(*one.model.name);
    }
  std::map<std::pair<std::string, std::optional<std::uint64_t>>, std::size_t> sizes;
  for (const auto& [model, group] : groups)
    ++sizes[group];
  std::size_t wanted = 0;  // one alone in its group is beside no other
  for (const auto& [group, size] : sizes)
    wanted += size > 1 ? size : 0;
  EXPECT_EQ(seen.size(), wanted);
  EXPECT_GT(wanted, 6U);
}

/// Where chance would take the image's own model the next by hash stands in, and nothing else moves.
TEST_F(DistractorsTest, AreNotTheImagesOwnModel) {
  for (const char* name : {"bus", "cup", "desk"})
    folder_.add(std::string("models/") + name + ".off");
  const std::vector<std::string> own{"distractors.dir=\"{models}\"", "distractors.count=5"};
  std::vector<std::string> with = own;
  with.emplace_back("distractors.own=true");
  const auto allowed = shown(recipe("", with)), others = shown(recipe("", own));
  ASSERT_EQ(allowed.size(), others.size());
  std::size_t redrawn = 0;
  for (const auto& [name, what] : allowed) {
    const std::string model = name.substr(0, name.find('/'));
    const bool is_own = std::get<0>(what) == model;
    redrawn += is_own ? 1U : 0U;
    EXPECT_NE(std::get<0>(others.at(name)), model) << name;
    EXPECT_EQ(others.at(name) != what, is_own) << name;
    EXPECT_EQ(std::get<1>(others.at(name)), std::get<1>(what)) << "its material stays";
    EXPECT_EQ(std::get<2>(others.at(name)), std::get<2>(what)) << "and what is drawn";
  }
  EXPECT_GT(redrawn, allowed.size() / 12);  // of 6 models each
  EXPECT_LT(redrawn, allowed.size() / 3);
  // It is the file that counts, whatever the folder.
  const Recipe same =
      recipe("", {"distractors.dir=\"" + (folder_.path() / "models").string() + "\""});
  ASSERT_FALSE(same.distractors.of_recipe);
  for (const ImageSpec& image : expand(same))
    for (const Distractor& one : draw_distractors(image, same))
      EXPECT_NE(*one.model.file, *image.model_file);
  // One model alone has none beside it.
  const Recipe alone = recipe(
      "", {own[0], "models.files=[\"" + (folder_.path() / "models/bus.off").string() + "\"]"});
  for (const ImageSpec& image : expand(alone))
    EXPECT_TRUE(draw_distractors(image, alone).empty());
}

TEST_F(DistractorsTest, ShowTheirOwnMaterialsWhereModelsDo) {
  const Recipe read = folder_.read_whole(
      "models.dir = \"models\"\nenvironments.dir = \"places\"\nmaterials.assign = \"own\"\n" +
      std::string(k_section));
  for (const ImageSpec& image : expand(read))
    for (const Distractor& one : draw_distractors(image, read)) {
      EXPECT_TRUE(one.material_file.is_same(one.model.file));
      EXPECT_EQ(*one.material_name, k_own_materials);
    }
}

TEST_F(DistractorsTest, WhatIsWrittenWrongIsSaid) {
  const auto findings = [&](std::string_view text) { return folder_.findings(text); };
  EXPECT_THAT(findings("distractors.count = 2\n"),
              HasSubstr("distractors.count has no effect with distractors.dir = false"));
  EXPECT_THAT(findings("distractors.dir = \"others\"\n"),
              HasSubstr("distractors.place_m must be given with distractors.dir"));
  EXPECT_THAT(findings("distractors.dir = \"others\"\ndistractors.place_m = [0, 0, 0]\n"),
              HasSubstr("distractors.place_m must be a distribution"));
  EXPECT_THAT(findings(std::string(k_section) + "distractors.class = \"a/b\"\n"),
              HasSubstr("distractors.class wants classes of the models beside it"));
  EXPECT_THAT(findings("distractors.dir = \"nowhere\"\ndistractors.place_m = { disc = 1 }\n"),
              HasSubstr("distractors.dir must be a folder"));
  EXPECT_THAT(findings("distractors.dir = \"{models}\"\ndistractors.place_m = { disc = 1 }\n"
                       "distractors.class = \"a\"\n"),
              HasSubstr("distractors.class has no effect"));
}

}  // namespace
}  // namespace ds
