// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/make/execute.h"
#include "tests/builder/fake_renderer.h"
#include "tracer/base/files.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace ds {

/// A copy of tests/data/tiny (two models, two materials, two environments, four views) in a
/// temporary folder, built with a fake renderer.
class TinyDataset : public testing::Test {
 protected:
  static constexpr std::uint64_t k_images = 8;

  TinyDataset() {
    std::filesystem::copy(DS_SOURCE_DIR "/tests/data/tiny", recipe_folder(),
                          std::filesystem::copy_options::recursive);
    request.target = recipe_folder() / "recipe.toml";
    request.output_folder = output();
  }

  std::filesystem::path recipe_folder() const { return folder_.path() / "tiny"; }
  std::filesystem::path output() const { return folder_.path() / "out"; }
  const std::filesystem::path& scratch() const { return folder_.path(); }

  /// One whole run of the program, as the command does it.
  BuildResult build(const BuildOptions& options = {}) { return build(real_disk, options); }
  BuildResult build(Disk& disk, const BuildOptions& options = {}) {
    calls.traced.clear();
    calls.planes.clear();
    Dataset dataset = open_dataset(request, Access::build, disk);
    Inputs inputs(*dataset.database);
    const Plan plan = make_plan(dataset, inputs, options.force, shard);
    BuildObserver observer;
    return execute(
        dataset, plan, inputs, options, disk,
        [this] { return std::make_unique<FakeRenderer>(calls); }, observer, stop);
  }
  Plan plan(Stamps stamps = Stamps::trust) {
    Dataset dataset = open_dataset(request, Access::look, real_disk);
    Inputs inputs(*dataset.database, stamps);
    return make_plan(dataset, inputs, false, shard);
  }
  std::vector<std::string> stale(Stamps stamps = Stamps::trust) {
    std::vector<std::string> ids;
    for (const PlannedImage& image : plan(stamps).images)
      if (image.stale()) ids.push_back(image.spec.id);
    return ids;
  }

  void edit(const std::string& file, const std::string& from, const std::string& to) {
    const std::filesystem::path path = recipe_folder() / file;
    std::string text = read_text_file(path);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write_file_atomic(path, text.replace(at, from.size(), to));
  }

  /// Every file of the dataset but the state folder, by relative path.
  std::map<std::string, std::string> contents() const { return contents(output()); }
  static std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      const std::string path = entry.path().lexically_relative(folder).generic_string();
      if (entry.is_regular_file() && !path.starts_with(".dsbuild"))
        files[path] = read_text_file(entry.path());
    }
    return files;
  }

  RealDisk real_disk;
  DatasetRequest request;
  Shard shard;
  FakeRenderer::Calls calls;
  std::atomic<bool> stop{false};

 private:
  TemporaryFolder folder_;
};

}  // namespace ds
