// SPDX-License-Identifier: Apache-2.0
// A manifest whose lines are taken over is the one that would be written anew, and costs nothing for
// each image that is as it was.
#include "manifests/manifest_writer.h"
#include "tests/builder/tiny_dataset.h"
#include "tracer/base/error.h"

#include <gtest/gtest.h>

#include <fstream>

namespace ds {
namespace {

namespace fs = std::filesystem;

class ManifestLines : public TinyDataset {
 protected:
  void distrust_lines() {
    const Dataset dataset = open_dataset(request, Access::build, real_disk);
    dataset.database->connection().execute(
        "UPDATE placed SET product = '00000000000000000000000000000000' WHERE path = "
        "'manifest/checksums.xxh128'");
  }
  std::map<std::string, std::string> manifest() {
    auto files = contents();
    std::erase_if(files, [](const auto& file) { return !file.first.starts_with("manifest/"); });
    return files;
  }
  /// Builds after the change, once with the lines that stand and once with none to be trusted.
  void expect_the_same(const std::function<void()>& change, const BuildOptions& options = {}) {
    build();
    const auto before = manifest();
    change();
    build(options);
    const auto taken_over = manifest();
    EXPECT_NE(taken_over, before);
    distrust_lines();
    build(options);
    EXPECT_EQ(manifest(), taken_over);
  }
  void spoil(const std::string& file) {
    std::ofstream(recipe_folder() / file, std::ios::app) << "\nnothing that can be read\n";
  }
};

TEST_F(ManifestLines, OfABrokenModel) {
  expect_the_same([this] { write_file_atomic(recipe_folder() / "models/box.off", "no model"); },
                  {.keep_going = true});
}

TEST_F(ManifestLines, OfABrokenEnvironment) {
  expect_the_same([this] { spoil("environments/floor/environment.scn"); }, {.keep_going = true});
}

TEST_F(ManifestLines, OfABrokenEnvironmentAndOtherLabels) {
  expect_the_same(
      [this] {
        spoil("environments/floor/environment.scn");
        request.overrides = {"classes.split={test=0.5}", "outputs.mask=false"};
      },
      {.keep_going = true});
}

TEST_F(ManifestLines, OfAChangedMaterial) {
  expect_the_same([this] { edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.75 0.1 0.1"); });
}

TEST_F(ManifestLines, OfAModelMoreAndOneLess) {
  expect_the_same([this] {
    fs::copy_file(recipe_folder() / "models/box.off", recipe_folder() / "models/new.off");
    fs::remove(recipe_folder() / "models/tetra.ply");
  });
}

TEST_F(ManifestLines, OfOtherLabelsAndOutputs) {
  expect_the_same([this] { request.overrides = {"classes.split={test=0.5}"}; });
  expect_the_same([this] { request.overrides = {"outputs.depth=\"exr\""}; });
  expect_the_same([this] { request.overrides = {"outputs.mask=false"}; });
}

TEST_F(ManifestLines, OfANameThatIsEscaped) {
  fs::copy_file(recipe_folder() / "models/box.off", recipe_folder() / "models/a\"id\":\"b.off");
  expect_the_same([this] { request.overrides = {"classes.split={test=0.5}"}; });
  expect_the_same([this] { spoil("environments/floor/environment.scn"); }, {.keep_going = true});
}

TEST_F(ManifestLines, OfAForcedBuild) {
  build();
  distrust_lines();
  build({.force = true});
  const auto anew = manifest();
  build({.force = true});
  EXPECT_EQ(manifest(), anew);
}

TEST_F(ManifestLines, CostNothingForEachImageThatIsAsItWas) {
  std::vector<std::int64_t> questions;
  for (const int views : {4, 8}) {
    request.overrides = {"camera.count=" + std::to_string(views)};
    request.output_folder = scratch() / ("out" + std::to_string(views));
    build();
    const std::string model = read_text_file(recipe_folder() / "models/box.off");
    write_file_atomic(recipe_folder() / "models/box.off", "no model");
    Dataset dataset = open_dataset(request, Access::build, real_disk);
    Inputs inputs(*dataset.database);
    const Plan plan = make_plan(dataset, inputs, false);
    const std::int64_t before = dataset.database->connection().runs();
    BuildObserver observer;
    const BuildResult result = execute(
        dataset, plan, inputs, {.keep_going = true}, real_disk,
        [this] { return std::make_unique<FakeRenderer>(calls); }, observer, stop);
    EXPECT_EQ(result.failed, static_cast<std::uint64_t>(views));
    questions.push_back(dataset.database->connection().runs() - before);
    write_file_atomic(recipe_folder() / "models/box.off", model);
  }
  EXPECT_EQ(questions[0], questions[1]);
}

TEST_F(ManifestLines, ThatWouldBeWrittenAgainStand) {
  build();
  const auto stamp = stamp_of(output() / "manifest/images.jsonl");
  request.overrides = {"dataset.licence=mine"};
  build();
  EXPECT_EQ(stamp_of(output() / "manifest/images.jsonl"), stamp);
  EXPECT_EQ(read_dataset_manifest(output()).licence, "mine");
}

TEST_F(ManifestLines, AreLeftAloneByAWriterThatIsGivenUp) {
  build();
  const auto before = manifest();
  {
    ManifestWriter writer(output());
    LineGlance image;
    for (int i = 100; i < 999; ++i) {
      const std::string id = std::to_string(i);
      image.id = id;
      writer.add(std::string(1000, 'x'), image);
    }
    image.id = "998";
    EXPECT_THROW(writer.add("", image), Error);
  }
  EXPECT_EQ(manifest(), before) << "no temporary file either";
}

}  // namespace
}  // namespace ds
