// SPDX-License-Identifier: Apache-2.0
// An environment that is known is not read, and none is taken for known that may be another.
#include "builder/plan/environment_facts.h"

#include "builder/plan/keys.h"
#include "tests/builder/opened.h"
#include "tests/builder/tiny_dataset.h"
#include "tracer/scene/sdl.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

namespace ds {
namespace {

namespace fs = std::filesystem;

class EnvironmentFactsTest : public TinyDataset {
 protected:
  fs::path floor() const { return recipe_folder() / "environments/floor"; }
  std::vector<fs::path> environments() const {
    std::vector<fs::path> folders;
    for (const auto& folder : fs::directory_iterator(recipe_folder() / "environments"))
      folders.push_back(folder.path());
    return folders;
  }
  /// Until their files are as old as files must be to be known by their stamps.
  static void wait_until_settled() { std::this_thread::sleep_for(std::chrono::milliseconds(2700)); }
  int opened_by_a_plan(Stamps stamps = Stamps::trust) {
    Opened opened(environments());
    plan(stamps);
    return opened.files();
  }
  static std::vector<SourceFile> sources(const std::vector<fs::path>& files) {
    return settled(files, now_ns() + 10'000'000'000).value();
  }
};

TEST_F(EnvironmentFactsTest, AreReadOnceOfFilesThatHaveSettled) {
  build();
  // Written anew: a build may take longer than files take to settle.
  const fs::path scene = floor() / "environment.scn";
  const std::string text = read_text_file(scene);
  std::ofstream(scene) << text;
  EXPECT_GT(opened_by_a_plan(), 0) << "what was just written may still change under its stamp";
  wait_until_settled();
  EXPECT_GT(opened_by_a_plan(), 0);
  EXPECT_EQ(opened_by_a_plan(), 0);
  EXPECT_EQ(stale().size(), 0U);
  EXPECT_GT(opened_by_a_plan(Stamps::ignore), 0) << "--rehash";
}

TEST_F(EnvironmentFactsTest, AreReadAgainWhereAnyOfTheirFilesIsAnother) {
  build();
  wait_until_settled();
  plan();
  EXPECT_EQ(opened_by_a_plan(), 0);
  // The same bytes in the same file.
  const fs::path scene = floor() / "environment.scn";
  const std::string text = read_text_file(scene);
  std::ofstream(scene) << text;
  EXPECT_GT(opened_by_a_plan(), 0);
  EXPECT_EQ(stale().size(), 0U);
  wait_until_settled();
  plan();
  EXPECT_EQ(opened_by_a_plan(), 0);
  // A film file where there was none.
  std::ofstream(floor() / "environment.cfg")
      << "film.imagepipeline.0.type = TONEMAP_LINEAR\nfilm.imagepipeline.0.scale = 0.125\n";
  EXPECT_EQ(stale().size(), k_images / 2);
  EXPECT_GT(opened_by_a_plan(), 0);
}

TEST_F(EnvironmentFactsTest, AreThoseOfTheScene) {
  const Scene scene = read_environment(floor());
  const EnvironmentFacts facts = facts_of(scene);
  const auto known = facts_from_text(to_text(facts, {}));
  ASSERT_TRUE(known);
  EXPECT_EQ(known->text, canonical_environment(scene));
  EXPECT_EQ(known->shapes, facts.shapes);
  EXPECT_EQ(canonical_tone_map(known->tone_map), canonical_tone_map(scene.tone_map));
  EXPECT_EQ(known->unphysical, facts.unphysical);
  EXPECT_EQ(known->longest_side_m, facts.longest_side_m);
  Scene empty;
  EXPECT_EQ(facts_of(empty).longest_side_m, 0);
}

TEST_F(EnvironmentFactsTest, HoldWhileEveryFileHasItsStamp) {
  const fs::path there = scratch() / "there", not_there = scratch() / "not there";
  std::ofstream(there) << "a";
  const EnvironmentFacts facts = facts_of(read_environment(floor()));
  const std::string text = to_text(facts, sources({there, not_there}));
  EXPECT_TRUE(facts_from_text(text));
  std::ofstream(not_there) << "b";
  EXPECT_FALSE(facts_from_text(text));
  fs::remove(not_there);
  EXPECT_TRUE(facts_from_text(text));
  fs::remove(there);
  EXPECT_FALSE(facts_from_text(text));
  EXPECT_FALSE(facts_from_text("{}"));
  EXPECT_FALSE(facts_from_text("no JSON"));
}

TEST_F(EnvironmentFactsTest, AreNotKeptOfAFileThatIsStillWritten) {
  std::ofstream(scratch() / "new") << "a";
  EXPECT_FALSE(settled({scratch() / "new"}, now_ns()));
  EXPECT_TRUE(settled({scratch() / "nowhere"}, now_ns()));
}

TEST_F(EnvironmentFactsTest, AProgramThatIsKnownByItsHashIsStillRecorded) {
  build();
  wait_until_settled();
  plan();
  // All images anew, from a plan that knows the programs by their hashes.
  request.overrides = {"engine.spp=2"};
  EXPECT_EQ(build().built, k_images);
  Dataset dataset = open_dataset(request, Access::look, real_disk);
  Inputs inputs(*dataset.database, Stamps::ignore);
  dataset.database->connection().execute("DELETE FROM known");
  TextSet texts;
  KeyMaker keys(dataset.recipe, inputs, texts);
  for (const ImageSpec& image : expand(dataset.recipe)) {
    keys.add_texts(image, keys.keys(image));
    texts.visit(keys.keys(image).parts[4], [&](Hash128 hash, const std::string& text) {
      EXPECT_EQ(dataset.database->find_text(hash), text);
    });
  }
}

}  // namespace
}  // namespace ds
