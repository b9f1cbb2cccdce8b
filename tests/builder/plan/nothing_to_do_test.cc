// SPDX-License-Identifier: Apache-2.0
// What a command costs where nothing changed: questions to the database, texts and opened files are
// those of the models and kinds of images, however many images there are.
#include "tests/builder/opened.h"
#include "tests/builder/tiny_dataset.h"
#include "tracer/base/hash_stream.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <set>
#include <thread>

namespace ds {
namespace {

namespace fs = std::filesystem;

struct Cost {
  std::int64_t questions = 0;  ///< to the database
  std::size_t texts = 0;       ///< canonical texts and programs made
  int opened = 0;              ///< files among the images and in the manifest's folder

  bool operator==(const Cost&) const = default;
};

void PrintTo(const Cost& cost, std::ostream* out) {
  *out << cost.questions << " questions, " << cost.texts << " texts, " << cost.opened << " opened";
}

class NothingToDo : public TinyDataset {
 protected:
  /// A dataset of `views` views of each model.
  void start(int views, std::vector<std::string> settings = {}) {
    settings.push_back("camera.count=" + std::to_string(views));
    request.overrides = std::move(settings);
    request.output_folder = scratch() / ("out" + std::to_string(views));
  }
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  void spoil_a_model() {
    std::ofstream(recipe_folder() / "models/box.off") << "neither OFF nor anything else";
  }
  /// What planning and building again cost, which must make nothing.
  Cost again(const BuildOptions& options = {}) {
    std::vector<fs::path> folders{request.output_folder / "manifest"};
    for (const auto& folder : fs::directory_iterator(request.output_folder / "images"))
      folders.push_back(folder.path());
    Opened opened(folders);
    calls.traced.clear();
    Dataset dataset = open_dataset(request, Access::build, real_disk);
    Inputs inputs(*dataset.database);
    const Plan plan = make_plan(dataset, inputs, false, shard);
    BuildObserver observer;
    const BuildResult result = execute(
        dataset, plan, inputs, options, real_disk,
        [this] { return std::make_unique<FakeRenderer>(calls); }, observer, stop);
    EXPECT_EQ(result.built, 0U);
    EXPECT_TRUE(calls.traced.empty());
    return {dataset.database->connection().runs(), plan.texts.size(), opened.files()};
  }
  /// As if the models had lain there for a while: stamps as new as theirs are not remembered.
  void let_models_age() {
    const Dataset dataset = open_dataset(request, Access::build, real_disk);
    for (const char* name : {"models/box.off", "models/tetra.ply"}) {
      const fs::path file = recipe_folder() / name;
      dataset.database->put_content(file, *stamp_of(file), content_hash(file));
    }
  }
  /// The same for 4 and for 8 views of each model.
  void expect_the_same_of_more(const std::vector<std::string>& settings,
                               const BuildOptions& options = {}) {
    // As old as environments' files must be to be known by their stamps: the same for both.
    std::this_thread::sleep_until(started_ + std::chrono::milliseconds(2700));
    std::vector<Cost> costs;
    for (const int views : {4, 8}) {
      start(views, settings);
      const Shard before = std::exchange(shard, {});
      build(options);
      shard = before;
      let_models_age();
      again(options);
      costs.push_back(again(options));
    }
    EXPECT_EQ(costs[0], costs[1]);
    EXPECT_EQ(costs[0].opened, 1) << "dataset.json, for what it says of the images";
  }
};

TEST_F(NothingToDo, CostsNothingForEachImage) {
  expect_the_same_of_more({});
}

TEST_F(NothingToDo, CostsNothingForEachImageOfAnErrorTarget) {
  expect_the_same_of_more({"engine.error=0.5", "engine.max_spp=64"});
}

TEST_F(NothingToDo, CostsNothingForEachImageOfAKeptFilm) {
  expect_the_same_of_more({"engine.keep_sums=true"});
}

TEST_F(NothingToDo, CostsNothingForEachImageThatFits) {
  expect_the_same_of_more({"camera.distance_m=\"fit\""});
}

TEST_F(NothingToDo, CostsNothingForEachImageOfAnotherShard) {
  shard = {1, 2};
  expect_the_same_of_more({});
}

TEST_F(NothingToDo, CostsNothingForEachImageThatCannotBeMade) {
  spoil_a_model();
  expect_the_same_of_more({}, {.keep_going = true});
}

TEST_F(NothingToDo, CostsNothingForEachImageThatCouldBeMadeBefore) {
  for (const int views : {4, 8}) {
    start(views);
    build();
  }
  spoil_a_model();
  for (const bool keep_going : {true, false})
    expect_the_same_of_more({}, {.keep_going = keep_going});
}

TEST_F(NothingToDo, IsOneLineOfTheLogAndNoOtherWrite) {
  build();
  Dataset dataset = open_dataset(request, Access::build, real_disk);
  const auto before = dataset.database->builds(dataset.row.id);
  const std::int64_t version = dataset.database->data_version();
  const auto pointer = stamp_of(output() / ".dsbuild/dataset");
  EXPECT_TRUE(build().ok());
  EXPECT_NE(dataset.database->data_version(), version);
  const auto after = dataset.database->builds(dataset.row.id);
  ASSERT_EQ(after.size(), before.size() + 1);
  EXPECT_EQ(after.front().outcome, "done");
  EXPECT_EQ(after.front().reused, k_images);
  EXPECT_EQ(stamp_of(output() / ".dsbuild/dataset"), pointer);
}

TEST_F(NothingToDo, ReadsNoImageOfAMaterialAgain) {
  const fs::path image = recipe_folder() / "textures/grey.pfm";
  const auto write = [&](float value) {
    std::string bytes = "Pf\n1 1\n-1.0\n";
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    write_file_atomic(image, bytes);
  };
  fs::create_directory(image.parent_path());
  write(0.25F);
  for (const char* name : {"red", "green"})
    write_file_atomic(recipe_folder() / "materials" / (std::string(name) + ".mat"),
                      fmt::format("scene.textures.t.type = imagemap\n"
                                  "scene.textures.t.file = ../textures/grey.pfm\n"
                                  "scene.materials.{0}.type = matte\n"
                                  "scene.materials.{0}.kd = t\n",
                                  name));
  std::this_thread::sleep_for(std::chrono::milliseconds(2700));  // until its stamp tells it
  build();
  Opened opened({image.parent_path()});
  EXPECT_TRUE(stale().empty());
  EXPECT_EQ(opened.files(), 0);
  EXPECT_TRUE(stale(Stamps::ignore).empty());
  EXPECT_EQ(opened.files(), 1) << "once, though two materials show it";
  write(0.5F);
  opened.files();
  EXPECT_EQ(stale().size(), k_images);
}

}  // namespace
}  // namespace ds
