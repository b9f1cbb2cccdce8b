// SPDX-License-Identifier: Apache-2.0
// What the manifest says apart from pixels, and what it goes on saying where a build cannot make
// all.
#include "builder/plan/manifest_state.h"

#include "manifests/manifest.h"
#include "tests/builder/tiny_dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace ds {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class ManifestStateTest : public TinyDataset {
 protected:
  std::vector<std::string> behind() { return plan().manifest.behind; }
  std::map<std::string, ImageRecord> records() const {
    std::map<std::string, ImageRecord> by_id;
    for (ImageRecord& record : read_images_manifest(output()))
      by_id.emplace(record.id, std::move(record));
    return by_id;
  }
  void spoil(const std::string& file) {
    std::ofstream(recipe_folder() / file, std::ios::app) << "scene.lights.sky.colour = 1 1 1\n";
  }
  std::uint64_t of_an_earlier_build() const {
    for (const auto& [name, count] : read_dataset_manifest(output()).counts)
      if (name == "of_an_earlier_build") return count;
    return 0;
  }
};

TEST_F(ManifestStateTest, IsBehindInWhatNoKeyHolds) {
  EXPECT_TRUE(plan().manifest.current()) << "nothing was built";
  build();
  EXPECT_TRUE(plan().manifest.current());
  edit("recipe.toml", "name = \"tiny\"", "name = \"renamed\"");
  edit("recipe.toml", "licence = \"CC0-1.0\"", "licence = \"mine\"");
  write_file_atomic(recipe_folder() / "models/LICENSE", std::string_view("do as you like"));
  EXPECT_THAT(behind(), ElementsAre("name: tiny -> renamed", "licence: CC0-1.0 -> mine",
                                    "licence texts: models/box.off, models/tetra.ply"));
  EXPECT_THAT(stale(), IsEmpty());
  EXPECT_EQ(build().built, 0U);
  EXPECT_TRUE(plan().manifest.current());
  EXPECT_EQ(read_dataset_manifest(output()).name, "renamed");
  request.overrides = {"engine.rejected_limit=0.5"};
  EXPECT_THAT(behind(), ElementsAre("settings: engine.rejected_limit"));
}

TEST_F(ManifestStateTest, IsBehindInClassesAndSplits) {
  build();
  request.overrides = {"classes.split={test=1.0}"};
  EXPECT_THAT(behind(), testing::Contains(AllOf(HasSubstr("split of 8 images (box.off/0: none -> "
                                                          "test)"))));
  build();
  EXPECT_TRUE(plan().manifest.current());
}

TEST_F(ManifestStateTest, ImagesToBeMadeAreNotTheManifestsOwnLag) {
  build();
  edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.75 0.1 0.1");
  fs::copy_file(recipe_folder() / "models/box.off", recipe_folder() / "models/new.off");
  EXPECT_THAT(behind(), IsEmpty());
}

TEST_F(ManifestStateTest, SeesAFileOfItsOwnThatIsGoneOrEdited) {
  build();
  fs::remove(output() / "manifest/dataset.json");
  std::ofstream(output() / "manifest/images.jsonl", std::ios::app) << "\n";
  EXPECT_THAT(behind(), ElementsAre("manifest/images.jsonl was changed on the disk",
                                    "manifest/dataset.json is missing"));
  build();
  EXPECT_TRUE(plan().manifest.current());
}

TEST_F(ManifestStateTest, AnInputThatCannotBeReadTakesNothingAway) {
  build();
  const auto files = contents();
  spoil("environments/floor/environment.scn");
  const Plan broken = plan();
  EXPECT_THAT(broken.to_remove, IsEmpty());
  const BuildResult result = build({.keep_going = true});
  EXPECT_EQ(result.failed, k_images / 2);
  EXPECT_EQ(result.reused, k_images / 2);
  EXPECT_EQ(records().size(), k_images);
  EXPECT_EQ(of_an_earlier_build(), k_images / 2);
  auto now = contents();
  EXPECT_EQ(now.at("manifest/images.jsonl"), files.at("manifest/images.jsonl"));
  build();  // stops at once; takes nothing away either
  EXPECT_EQ(records().size(), k_images);
  // Those that can be made are made anew, and the labels of the others kept up.
  edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.75 0.1 0.1");
  request.overrides = {"classes.split={test=1.0}"};
  EXPECT_EQ(build({.keep_going = true}).built, k_images / 4);
  const auto after = records();
  ASSERT_EQ(after.size(), k_images);
  for (const auto& [id, record] : after)
    EXPECT_EQ(record.split, "test") << id;
}

TEST_F(ManifestStateTest, AnOlderImageWhoseFileIsGoneIsNotListed) {
  build();
  spoil("environments/floor/environment.scn");
  std::string id;
  for (const PlannedImage& image : plan().images)
    if (image.error) id = image.spec.id;
  fs::remove(output() / output_path(id, ".mask.png"));
  build();
  EXPECT_EQ(records().size(), k_images - 1);
  EXPECT_FALSE(records().contains(id));
}

// Nothing changes between the builds but the files of an image that cannot be made.
TEST_F(ManifestStateTest, AStandingManifestOfABrokenRecipeFollowsTheFiles) {
  build();
  spoil("environments/floor/environment.scn");
  std::vector<std::string> ids;
  for (const PlannedImage& image : plan().images)
    if (image.error) ids.push_back(image.spec.id);
  for (const bool keep_going : {true, false}) {
    build({.keep_going = keep_going});
    const auto stamp = stamp_of(output() / "manifest/images.jsonl");
    build({.keep_going = !keep_going});
    EXPECT_EQ(stamp_of(output() / "manifest/images.jsonl"), stamp) << "written again for nothing";
    const fs::path mask = output() / output_path(ids.back(), ".mask.png");
    if (keep_going)
      fs::remove(mask);
    else
      write_file_atomic(mask, std::string_view("another's"));
    build({.keep_going = keep_going});
    EXPECT_FALSE(records().contains(ids.back()));
    ids.pop_back();
    EXPECT_TRUE(records().contains(ids.back()));
  }
}

TEST_F(ManifestStateTest, LinesOfImagesThatNoRecipeHasAreLookedAtAgain) {
  build();
  fs::remove(recipe_folder() / "models/tetra.ply");
  spoil("environments/floor/environment.scn");
  build();  // stops at once
  EXPECT_EQ(records().size(), k_images);
  fs::remove(output() / output_path("tetra.ply/0", ".mask.png"));
  build();
  EXPECT_EQ(records().size(), k_images - 1);
}

TEST_F(ManifestStateTest, ABuildCutShortListsWhatIsInPlace) {
  build();
  edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.75 0.1 0.1");
  edit("materials/green.mat", "kd = 0.1 0.6 0.1", "kd = 0.1 0.5 0.1");
  fs::remove(recipe_folder() / "models/tetra.ply");
  calls.stop_after_one = &stop;
  EXPECT_EQ(build().built, 1U);
  const auto cut = records();
  EXPECT_EQ(cut.size(), k_images) << "the tetrahedron's files are still there";
  for (const auto& [id, record] : cut)
    for (const FileRecord& file : record.files)
      EXPECT_EQ(hash_file(output() / file.path).xxh128, file.hashes.xxh128) << file.path;
  EXPECT_EQ(of_an_earlier_build(), k_images - 1);
  calls.stop_after_one = nullptr;
  stop = false;
  EXPECT_TRUE(build().ok());
  EXPECT_EQ(records().size(), k_images / 2);
  EXPECT_EQ(of_an_earlier_build(), 0U);
}

}  // namespace
}  // namespace ds
