// SPDX-License-Identifier: Apache-2.0
#include "builder/store/host.h"
#include "builder/store/killed_builds.h"
#include "manifests/manifest.h"
#include "tests/builder/tiny_dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace ds {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

class BuildTest : public TinyDataset {};

TEST_F(BuildTest, MakesEveryImageOnceAndNothingTheSecondTime) {
  const BuildResult first = build();
  EXPECT_TRUE(first.ok());
  EXPECT_EQ(first.built, k_images);
  EXPECT_EQ(first.traced_samples, k_images * 32 * 32);
  EXPECT_EQ(first.device, "fake");
  EXPECT_THAT(calls.traced, SizeIs(k_images));
  const auto files = contents();
  EXPECT_EQ(files.size(), k_images * 2 + 3);
  const BuildResult second = build();
  EXPECT_TRUE(second.ok());
  EXPECT_EQ(second.built, 0U);
  EXPECT_EQ(second.reused, k_images);
  EXPECT_EQ(second.traced_samples, 0U);
  EXPECT_EQ(second.device, "") << "no device is opened for nothing";
  EXPECT_EQ(contents(), files);
}

TEST_F(BuildTest, TracesImagesOfOneSceneOneAfterAnother) {
  build();
  // cycle: with two materials and two environments, every other view is of one scene.
  const auto scene = [](const std::string& id) {
    return id.substr(0, id.size() - 1) + (id.back() % 2 == 0 ? "even" : "odd");
  };
  std::size_t changes = 0;
  for (std::size_t i = 1; i < calls.traced.size(); ++i)
    changes += scene(calls.traced[i]) != scene(calls.traced[i - 1]) ? 1U : 0U;
  EXPECT_EQ(changes, 3U) << "four scenes";
}

TEST_F(BuildTest, AnnouncesOneImageOfEachKindInTheOrderTheyAreTraced) {
  request.overrides = {"materials.assign=all", "environments.assign=all"};
  build();
  // Two models of four views, with two materials in two environments: the model makes no kind of
  // its own, so the first model's first view of each pair is announced.
  ASSERT_THAT(calls.traced, SizeIs(2 * 4 * 4));
  EXPECT_THAT(calls.announced,
              ElementsAre(calls.traced[0], calls.traced[4], calls.traced[8], calls.traced[12]));
  calls.announced.clear();
  EXPECT_EQ(build().built, 0U);
  EXPECT_THAT(calls.announced, IsEmpty());
}

TEST_F(BuildTest, ExpectsTheNextSceneWhenOneIsBegun) {
  request.overrides = {"materials.assign=all"};
  build();
  // Two models of four views with two materials, by turns in two environments: eight scenes of two
  // images each.
  ASSERT_THAT(calls.traced, SizeIs(2 * 4 * 2));
  ASSERT_THAT(calls.expected, SizeIs(7));
  for (std::size_t i = 0; i < calls.expected.size(); ++i)
    EXPECT_EQ(calls.expected[i], calls.traced[2 * (i + 1)]);
}

/// What follows is made as ever: image by image, each to the end, takes seven times as long.
TEST_F(BuildTest, OnlyTheImageThatAProcessDiedAtIsMadeFirstAndByItself) {
  request.overrides = {"materials.assign=all"};
  build();
  std::vector<std::string> order = calls.traced;
  ASSERT_THAT(order, SizeIs(2 * 4 * 2));
  request.output_folder = scratch() / "another";
  calls.announced.clear();
  calls.expected.clear();
  BuildOptions options;
  options.earlier.crashed = {{order[5], "died of signal 11"}};
  options.earlier.deaths = 1;
  build(options);
  std::rotate(order.begin(), order.begin() + 5, order.begin() + 6);
  EXPECT_EQ(calls.traced, order);
  EXPECT_THAT(calls.announced, IsEmpty()) << "programs are compiled in the image that needs them";
  EXPECT_THAT(calls.expected,
              ElementsAre(order[3], order[5], order[6], order[8], order[10], order[12], order[14]));
}

/// Of a process that died, what comes after it counts what it made, and makes none of it again.
TEST_F(BuildTest, WhatAnEarlierProcessMadeIsMadeOnce) {
  MadeJournal journal;
  BuildOptions options;
  options.earlier.journal = &journal;
  build(options);
  const MadeImages made = journal.read();
  ASSERT_THAT(made, SizeIs(k_images));
  for (const auto& [image, what] : made) {
    EXPECT_TRUE(what.placed);
    EXPECT_TRUE(what.work.traced && what.work.developed);
    EXPECT_EQ(what.work.samples, 32U * 32U);
  }
  options.earlier.made = made;
  options.earlier.deaths = 1;
  for (const bool force : {false, true}) {
    options.force = force;
    const BuildResult result = build(options);
    EXPECT_EQ(result.built, k_images);
    EXPECT_EQ(result.traced, k_images);
    EXPECT_EQ(result.traced_samples, k_images * 32 * 32);
    EXPECT_EQ(result.reused, 0U);
    EXPECT_THAT(calls.traced, IsEmpty());
  }
  // One that was begun and is not known to be in place is traced anew where all are to be, and else
  // where it is not there.
  MadeImage& first = options.earlier.made.begin()->second;
  first.placed = false;
  EXPECT_EQ(build(options).traced, k_images);
  EXPECT_THAT(calls.traced, SizeIs(1));
  options.force = false;
  EXPECT_EQ(build(options).traced, k_images);
  EXPECT_THAT(calls.traced, IsEmpty());
}

TEST_F(BuildTest, AToneMapDevelopsAnewAndTracesNothing) {
  build();
  const auto before = contents();
  request.overrides = {"outputs.tone_map=linear", "outputs.tone_map_scale=0.5"};
  const BuildResult result = build();
  EXPECT_EQ(result.built, k_images);
  EXPECT_EQ(result.developed, k_images);
  EXPECT_EQ(result.traced, 0U);
  EXPECT_EQ(result.traced_samples, 0U);
  EXPECT_NE(contents().at("images/box.off/0.png"), before.at("images/box.off/0.png"));
  EXPECT_EQ(contents().at("images/box.off/0.mask.png"), before.at("images/box.off/0.mask.png"));
  // And back: everything is in the store.
  request.overrides.clear();
  EXPECT_EQ(build().developed, 0U);
  EXPECT_EQ(contents(), before);
}

TEST_F(BuildTest, ARecipeOfMasksAndDepthsTracesNoPath) {
  request.overrides = {"outputs.image=false", "outputs.depth=exr"};
  const BuildResult result = build();
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(result.built, k_images);
  EXPECT_EQ(result.traced_samples, 0U);
  EXPECT_THAT(calls.traced, IsEmpty());
  EXPECT_THAT(calls.announced, IsEmpty()) << "no path program is made";
  EXPECT_THAT(calls.planes, SizeIs(k_images));
  EXPECT_EQ(contents().size(), k_images * 2 + 3);
  EXPECT_FALSE(fs::exists(output() / "images/box.off/0.png"));
  EXPECT_EQ(build().reused, k_images);
}

TEST_F(BuildTest, ARecipeOfPicturesAloneTracesNoGeometry) {
  request.overrides = {"outputs.mask=false", "outputs.depth=false"};
  const BuildResult result = build();
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(result.built, k_images);
  EXPECT_THAT(calls.traced, SizeIs(k_images));
  EXPECT_THAT(calls.planes, IsEmpty());
  EXPECT_EQ(contents().size(), k_images + 3) << "no mask, no depth";
  build({.force = true});
  EXPECT_THAT(calls.planes, IsEmpty());
  // A mask asked for later traces itself alone.
  request.overrides = {"outputs.depth=false"};
  EXPECT_EQ(build().traced_samples, 0U);
  EXPECT_THAT(calls.planes, SizeIs(k_images));
}

TEST_F(BuildTest, DepthTracesGeometryOnly) {
  build();
  request.overrides = {"outputs.depth=exr"};
  const BuildResult result = build();
  EXPECT_EQ(result.built, k_images);
  EXPECT_EQ(result.traced_samples, 0U);
  EXPECT_THAT(calls.traced, IsEmpty());
  EXPECT_THAT(calls.planes, SizeIs(k_images));
  EXPECT_TRUE(fs::exists(output() / "images/box.off/0.depth.exr"));
  request.overrides.clear();
  EXPECT_EQ(build().reused, k_images);
  EXPECT_FALSE(fs::exists(output() / "images/box.off/0.depth.exr")) << "no longer asked for";
}

TEST_F(BuildTest, PlanesOfLightAreTracedWithThePicture) {
  request.overrides = {R"(outputs.planes=["direct_diffuse", "EMISSION:half"])"};
  BuildResult result = build();
  EXPECT_EQ(result.traced_samples, k_images * 32 * 32) << "one tracing for all";
  EXPECT_THAT(calls.traced, SizeIs(k_images));
  EXPECT_TRUE(fs::exists(output() / "images/box.off/0.emission.exr"));
  const auto before = contents();
  EXPECT_EQ(build().reused, k_images);
  // One more is traced anew and leaves all others.
  request.overrides = {R"(outputs.planes=["direct_diffuse", "emission:half", "indirect_glossy"])"};
  result = build();
  EXPECT_EQ(result.traced_samples, k_images * 32 * 32);
  EXPECT_EQ(result.developed, 0U);
  EXPECT_THAT(calls.planes, IsEmpty());
  for (const auto& [file, bytes] : contents())
    if (before.contains(file) && file.starts_with("images/")) {
      EXPECT_EQ(before.at(file), bytes) << file;
    }
  // The picture by itself, and planes of light without one.
  fs::remove_all(output());
  request.overrides = {"outputs.image=false", "outputs.mask=false",
                       R"(outputs.planes=["direct_diffuse"])"};
  result = build();
  EXPECT_EQ(result.traced_samples, k_images * 32 * 32);
  EXPECT_EQ(contents().size(), k_images + 3);
}

TEST_F(BuildTest, ByFastArithmeticThePictureIsTracedApart) {
  request.overrides = {"engine.math=fast", R"(outputs.planes=["direct_diffuse"])"};
  EXPECT_EQ(build().traced_samples, 2 * k_images * 32 * 32);
  EXPECT_EQ(build().reused, k_images);
}

TEST_F(BuildTest, WithoutKeptFilmsAToneMapTracesAgain) {
  request.overrides = {"outputs.keep_film=false"};
  build();
  EXPECT_EQ(build().reused, k_images);
  request.overrides.insert(request.overrides.end(),
                           {"outputs.tone_map=linear", "outputs.tone_map_scale=0.5"});
  EXPECT_EQ(build().traced, k_images);
}

TEST_F(BuildTest, ARemovedFileComesFromTheStore) {
  build();
  const auto files = contents();
  fs::remove(output() / "images/tetra.ply/3.png");
  const BuildResult result = build();
  EXPECT_EQ(result.built, 1U);
  EXPECT_EQ(result.reused, k_images - 1);
  EXPECT_EQ(result.traced + result.developed, 0U);
  EXPECT_EQ(contents(), files);
}

TEST_F(BuildTest, AnEditedMaterialTracesItsImagesOnly) {
  build();
  edit("materials/green.mat", "kd = 0.1 0.6 0.1", "kd = 0.1 0.5 0.1");
  const BuildResult result = build();
  EXPECT_EQ(result.built, k_images / 2);
  EXPECT_EQ(result.traced_samples, k_images / 2 * 32 * 32);
  EXPECT_THAT(calls.planes, IsEmpty());
  // The old colour again: paid for already.
  edit("materials/green.mat", "kd = 0.1 0.5 0.1", "kd = 0.1 0.6 0.1");
  EXPECT_EQ(build().traced, 0U);
}

TEST_F(BuildTest, ForceTracesEverythingAndChangesNoByte) {
  build();
  const auto files = contents();
  const BuildResult result = build({.force = true});
  EXPECT_EQ(result.built, k_images);
  EXPECT_EQ(result.traced, k_images);
  EXPECT_EQ(contents(), files);
}

TEST_F(BuildTest, ADamagedObjectIsMadeAgainAndNeverPlaced) {
  build();
  const auto files = contents();
  for (const auto& entry : fs::recursive_directory_iterator(output() / ".dsbuild/objects")) {
    if (!entry.is_regular_file()) continue;
    std::string bytes = read_text_file(entry.path());
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    write_file_atomic(entry.path(), bytes);
  }
  fs::remove_all(output() / "images");
  const BuildResult result = build();
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(result.traced, k_images);
  EXPECT_EQ(contents(), files);
}

TEST_F(BuildTest, AFileDamagedInPlaceIsMended) {
  build();
  const auto files = contents();
  const fs::path file = output() / "images/box.off/2.png";
  // Through a hard link this damages the store's object too.
  fs::permissions(file, fs::perms::owner_write, fs::perm_options::add);
  std::fstream out(file, std::ios::in | std::ios::out | std::ios::binary);
  out.seekp(20);
  out << "damage";
  out.close();
  const BuildResult result = build();
  EXPECT_EQ(result.built, 1U);
  EXPECT_EQ(result.traced, 0U) << "the film is whole";
  EXPECT_EQ(contents(), files);
}

TEST_F(BuildTest, ALostDatabaseCostsNoTracing) {
  build();
  const auto files = contents();
  for (const char* name : {"dsbuild.sqlite", "dsbuild.sqlite-wal", "dsbuild.sqlite-shm"})
    fs::remove(output() / ".dsbuild" / name);
  const BuildResult result = build();
  EXPECT_EQ(result.traced + result.developed, 0U);
  EXPECT_EQ(contents(), files);
}

TEST_F(BuildTest, StopsAfterTheImageUnderWayAndGoesOnLater) {
  build();
  const auto files = contents();
  fs::remove_all(output());
  calls.stop_after_one = &stop;
  const BuildResult stopped = build();
  EXPECT_TRUE(stopped.stopped);
  EXPECT_EQ(stopped.built, 1U);
  EXPECT_EQ(stopped.not_reached, k_images - 1);
  EXPECT_THAT(read_images_manifest(output()), SizeIs(1)) << "the manifest lists what is there";
  calls.stop_after_one = nullptr;
  stop = false;
  const BuildResult rest = build();
  EXPECT_EQ(rest.reused, 1U);
  EXPECT_EQ(rest.built, k_images - 1);
  EXPECT_EQ(contents(), files);
}

TEST_F(BuildTest, AFailingImageStopsTheBuildUnlessItIsToGoOn) {
  calls.fails_on = "box.off/2";
  const BuildResult cut = build();
  EXPECT_FALSE(cut.ok());
  EXPECT_EQ(cut.failed, 1U);
  EXPECT_GT(cut.not_reached, 0U);
  const BuildResult all = build({.keep_going = true});
  EXPECT_FALSE(all.ok());
  EXPECT_EQ(all.failed, 1U);
  EXPECT_EQ(all.built + all.reused, k_images - 1);
  EXPECT_THAT(all.failures, ElementsAre(testing::Pair("box.off/2", HasSubstr("told to fail"))));
  EXPECT_THAT(read_images_manifest(output()), SizeIs(k_images - 1));
}

TEST_F(BuildTest, ABadModelIsOneFailureForAllItsImages) {
  write_file_atomic(recipe_folder() / "models/bad.ply",
                    std::string_view("ply\nformat ascii 1.0\n"));
  const BuildResult cut = build();
  EXPECT_EQ(cut.failed, 4U);
  EXPECT_EQ(cut.built, 0U) << "nothing is traced for a dataset that cannot become whole";
  const BuildResult rest = build({.keep_going = true});
  EXPECT_EQ(rest.failed, 4U);
  EXPECT_EQ(rest.built, k_images);
  ASSERT_THAT(rest.failures, SizeIs(1));
  EXPECT_THAT(rest.failures[0].first, HasSubstr("4 images"));
  EXPECT_THAT(rest.failures[0].second, HasSubstr("bad.ply"));
}

TEST_F(BuildTest, AMendedModelStandsInTheManifest) {
  build();
  EXPECT_THAT(plan().mended, IsEmpty());
  EXPECT_THAT(contents().at("manifest/dataset.json"), Not(HasSubstr("mended_models")));
  write_file_atomic(recipe_folder() / "models/torn.off",
                    std::string_view("OFF 4 3 0\n0 0 0\n1 0 0\n0 1 0\n3e38 0 0\n"
                                     "3 0 1 2\n3 0 1 3\n3 0 1 9\n"));
  const MendedDamage damage{{"out_of_range", 1}, {"non_finite", 1}};
  EXPECT_TRUE(build().ok()) << "it is a warning";
  const auto files = contents();
  // By a database that knows the file, and by one that does not.
  for (int i = 0; i < 2; ++i) {
    const Plan known = plan();
    ASSERT_THAT(known.mended, SizeIs(1)) << "once, not once an image";
    EXPECT_EQ(known.mended.at("torn.off").damage, damage);
    EXPECT_EQ(known.mended.at("torn.off").file.filename(), "torn.off");
    const DatasetRecord record = read_dataset_manifest(output());
    ASSERT_THAT(record.mended_models, SizeIs(1));
    EXPECT_EQ(record.mended_models[0].first, "torn.off");
    EXPECT_EQ(record.mended_models[0].second,
              (MendedDamage{{"non_finite", 1}, {"out_of_range", 1}}));
    for (const char* name : {"dsbuild.sqlite", "dsbuild.sqlite-wal", "dsbuild.sqlite-shm"})
      fs::remove(output() / ".dsbuild" / name);
    build();
    EXPECT_EQ(contents(), files);
  }
  fs::remove(recipe_folder() / "models/torn.off");
  build();
  EXPECT_THAT(contents().at("manifest/dataset.json"), Not(HasSubstr("mended_models")));
}

TEST_F(BuildTest, WhatTheRecipeNoLongerNamesIsRemovedAndOthersFilesAreNot) {
  build();
  write_file_atomic(output() / "images/box.off/note.txt", std::string_view("mine"));
  fs::remove(recipe_folder() / "models/box.off");
  EXPECT_EQ(build().images, k_images / 2);
  EXPECT_FALSE(fs::exists(output() / "images/box.off/0.png"));
  EXPECT_TRUE(fs::exists(output() / "images/box.off/note.txt"));
}

TEST_F(BuildTest, AChangedManifestIsWrittenAgain) {
  build();
  const auto files = contents();
  write_file_atomic(output() / "manifest/images.jsonl", std::string_view("{}\n"));
  fs::remove(output() / "manifest/dataset.json");
  EXPECT_EQ(build().built, 0U);
  EXPECT_EQ(contents(), files);
}

TEST_F(BuildTest, ASharedStoreServesTwoDatasets) {
  request.store_folder = scratch() / "store";
  build();
  const auto files = contents();
  request.output_folder = scratch() / "second";
  const BuildResult result = build();
  EXPECT_EQ(result.built, k_images);
  EXPECT_EQ(result.traced + result.developed, 0U);
  EXPECT_EQ(contents(scratch() / "second"), files);
}

TEST_F(BuildTest, AFolderStandsForTheRecipeItWasBuiltFrom) {
  request.overrides = {"camera.count=2"};
  build();
  const auto files = contents();
  request = {};
  request.target = output();
  EXPECT_EQ(build().reused, 4U);
  EXPECT_EQ(contents(), files);
  request.overrides = {"camera.count=3"};
  EXPECT_THROW(build(), Error);
}

TEST_F(BuildTest, AMovedDatasetTakesItsStoreAlong) {
  build();
  fs::rename(output(), scratch() / "moved");
  request = {};
  request.target = scratch() / "moved";
  const BuildResult result = build();
  EXPECT_EQ(result.reused, k_images);
}

TEST_F(BuildTest, CleansUpAfterAKilledBuildAndNotAfterARunningOne) {
  build();
  const auto files = contents();
  const fs::path killed = output() / "images/box.off/.0.png.999999999.0.tmp";
  const fs::path running = output() / "images/box.off/.1.png.1.0.tmp";  // of process 1
  write_file_atomic(killed, std::string_view("half"));
  write_file_atomic(running, std::string_view("half"));
  {
    const Dataset dataset = open_dataset(request, Access::build, real_disk);
    dataset.database->begin_build(dataset.row.id, host_name(), 999999999);
    EXPECT_TRUE(was_killed(dataset.database->builds(dataset.row.id).front()));
    BuildRow other = dataset.database->builds(dataset.row.id).front();
    other.process = 1;
    EXPECT_FALSE(was_killed(other));
    other.process = 999999999;
    other.host = "elsewhere";
    EXPECT_FALSE(was_killed(other));
  }
  build();
  EXPECT_FALSE(fs::exists(killed));
  EXPECT_TRUE(fs::exists(running));
  fs::remove(running);
  EXPECT_EQ(contents(), files);
  const Dataset dataset = open_dataset(request, Access::look, real_disk);
  const auto builds = dataset.database->builds(dataset.row.id);
  ASSERT_THAT(builds, SizeIs(3));
  EXPECT_EQ(builds[1].outcome, "killed");
}

TEST_F(BuildTest, TellsTheTimeOfTheWholeCommand) {
  BuildOptions options;
  options.started -= std::chrono::hours(1);  // spent on planning
  EXPECT_GE(build(options).seconds, 3600);
  const Dataset dataset = open_dataset(request, Access::look, real_disk);
  EXPECT_GE(dataset.database->builds(dataset.row.id)[0].seconds, 3600);
}

TEST_F(BuildTest, RecordsWhenAndWhereItWasBuilt) {
  build();
  const Dataset dataset = open_dataset(request, Access::look, real_disk);
  const auto builds = dataset.database->builds(dataset.row.id);
  ASSERT_THAT(builds, SizeIs(1));
  EXPECT_EQ(builds[0].outcome, "done");
  EXPECT_EQ(builds[0].device, "fake");
  EXPECT_EQ(builds[0].built, k_images);
}

}  // namespace
}  // namespace ds
