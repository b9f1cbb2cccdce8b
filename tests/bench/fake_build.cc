// SPDX-License-Identifier: Apache-2.0
// Builds a dataset as `dsbuild build RECIPE -o FOLDER` does, but with pictures that are made up and
// a disk that is not waited for: the quickest way to a state where nothing is left to do, every
// file, row and record of it written by the builder itself.
//
//   fake_build RECIPE FOLDER
#include "builder/make/execute.h"
#include "tests/builder/fake_renderer.h"
#include "tracer/base/error.h"

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Writes without fsync: what a power cut would leave is of no interest here.
class HastyDisk : public Disk {
 public:
  void write(const fs::path& file, std::span<const std::byte> bytes) override {
    fs::create_directories(file.parent_path());
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) fail(ErrorKind::io, "{}: cannot write", file.string());
  }
  void link(const fs::path& from, const fs::path& to) override { copy(from, to); }
  void copy(const fs::path& from, const fs::path& to) override {
    fs::create_directories(to.parent_path());
    fs::copy_file(from, to, fs::copy_options::overwrite_existing);
  }
  void remove(const fs::path& file) override { fs::remove(file); }
};

class Counter : public BuildObserver {
 public:
  void started(std::uint64_t images, std::uint64_t /*samples*/) override { images_ = images; }
  void image_done(const PlannedImage& /*image*/, const ImageWork& /*work*/) override {
    constexpr std::uint64_t k_step = 1000;
    if (++done_ % k_step == 0) fmt::print(stderr, "{} of {} images\n", done_, images_);
  }

 private:
  std::uint64_t images_ = 0, done_ = 0;
};

int run(const fs::path& recipe, const fs::path& folder) {
  HastyDisk disk;
  DatasetRequest request;
  request.target = recipe;
  request.output_folder = folder;
  Dataset dataset = open_dataset(request, Access::build, disk);
  dataset.database->connection().execute("PRAGMA synchronous = OFF");
  Inputs inputs(*dataset.database);
  const Plan plan = make_plan(dataset, inputs, false);
  FakeRenderer::Calls calls;
  Counter counter;
  const std::atomic<bool> stop{false};
  const BuildResult result = execute(
      dataset, plan, inputs, {}, disk, [&] { return std::make_unique<FakeRenderer>(calls); },
      counter, stop);
  for (const auto& [what, why] : result.failures)
    fmt::print(stderr, "{}: {}\n", what, why);
  fmt::print("{} images, {} built, {} reused\n", result.images, result.built, result.reused);
  return result.ok() ? 0 : 1;
}

}  // namespace
}  // namespace ds

int main(int count, char** arguments) {
  try {
    if (count != 3) ds::fail(ds::ErrorKind::usage, "wanted RECIPE FOLDER");
    return ds::run(arguments[1], arguments[2]);
  } catch (const ds::Error& error) {
    fmt::print(stderr, "fake_build: {}\n", error.what());
    return 1;
  }
}
