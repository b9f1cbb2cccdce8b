// SPDX-License-Identifier: Apache-2.0
// The disk fails at every single operation of a build, one after the other; whatever is left, the
// next build makes the same bytes as one that nothing happened to.
#include "builder/plan/dataset_manifest.h"
#include "tests/builder/tiny_dataset.h"
#include "tracer/base/disk_error.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>
#include <set>

namespace ds {
namespace {

namespace fs = std::filesystem;

enum class Fault {
  refuse,  ///< as a full disk: an error, nothing written
  crash,   ///< as kill -9 before the operation: nothing after it happens
  tear,    ///< as a machine that loses power on a disk that lies: half of the file under its final
           ///< name, then nothing
};

struct Crash {};

class FaultyDisk : public RealDisk {
 public:
  FaultyDisk(Fault fault, std::size_t at) : fault_(fault), left_(at) {}
  bool reached() const { return reached_; }

  void write(const fs::path& file, std::span<const std::byte> bytes) override {
    if (due()) strike(file, bytes);
    RealDisk::write(file, bytes);
  }
  void link(const fs::path& from, const fs::path& to) override {
    if (due()) strike(to, bytes_of("half of a picture"));
    RealDisk::link(from, to);
  }
  void write_all(std::span<const FileToWrite> files) override { Disk::write_all(files); }
  void place_all(std::span<const FileToPlace> files) override { Disk::place_all(files); }
  void remove(const fs::path& file) override {
    if (due()) strike(file, {});
    RealDisk::remove(file);
  }

 private:
  bool due() {
    const bool now = !reached_ && left_-- == 0;
    reached_ = reached_ || now;
    return now || (reached_ && fault_ == Fault::refuse);
  }
  void strike(const fs::path& file, std::span<const std::byte> bytes) {
    if (fault_ == Fault::refuse)
      throw DiskFailed(file.string() + ": cannot write: no space left on device");
    if (fault_ == Fault::tear && !bytes.empty()) {
      fs::create_directories(file.parent_path());
      fs::remove(file);
      const std::string half(reinterpret_cast<const char*>(bytes.data()), bytes.size() / 2);
      std::ofstream(file, std::ios::binary) << half;
    }
    throw Crash{};
  }

  Fault fault_;
  std::size_t left_;
  bool reached_ = false;
};

class BuildFaultsTest : public TinyDataset, public testing::WithParamInterface<Fault> {};

TEST_P(BuildFaultsTest, TheNextBuildGivesTheSameBytes) {
  request.overrides = {"camera.count=2", "outputs.depth=exr"};
  build();
  const auto wanted = contents();
  std::size_t at = 0;
  for (bool reached = true; reached; ++at) {
    SCOPED_TRACE(at);
    fs::remove_all(output());
    FaultyDisk disk(GetParam(), at);
    try {
      const BuildResult result = build(disk);
      if (disk.reached()) {
        EXPECT_FALSE(result.ok());
      }
    } catch (const Crash&) {
    } catch (const Error&) {
      EXPECT_EQ(GetParam(), Fault::refuse);
    }
    reached = disk.reached();
    const BuildResult result = build();
    EXPECT_TRUE(result.ok());
    ASSERT_EQ(contents(), wanted);
    EXPECT_EQ(build().reused, 4U);
  }
  EXPECT_GT(at, 30U) << "the build must go through the disk that fails";
}

/// Refuses to place one name.
class PickyDisk : public RealDisk {
 public:
  explicit PickyDisk(std::string name) : name_(std::move(name)) {}
  void link(const fs::path& from, const fs::path& to) override {
    if (to.filename() == name_) fail_system(to, "rename a finished temporary to", ENAMETOOLONG);
    RealDisk::link(from, to);
  }
  void place_all(std::span<const FileToPlace> files) override { Disk::place_all(files); }
  void remove(const fs::path& file) override {
    if (file.filename() == name_) fail_system(file, "remove", EACCES);
    RealDisk::remove(file);
  }

 private:
  std::string name_;
};

class OneNameTest : public TinyDataset {
 protected:
  std::set<std::string> listed() const {
    std::set<std::string> paths;
    for (const ImageRecord& image : read_images_manifest(output()))
      for (const FileRecord& file : image.files)
        paths.insert(file.path);
    return paths;
  }
  std::set<std::string> in_place() const {
    std::set<std::string> paths;
    for (const auto& [path, text] : contents())
      if (path.starts_with("images/")) paths.insert(path);
    return paths;
  }
};

TEST_F(OneNameTest, AnImageThatCannotBePlacedFailsAlone) {
  request.overrides = {"camera.count=2", "outputs.depth=exr"};
  PickyDisk disk("1.depth.exr");  // of both models, the last file of its image
  const BuildResult result = build(disk, {.keep_going = true});
  EXPECT_EQ(result.built, 2U);
  EXPECT_EQ(result.failed, 2U);
  EXPECT_EQ(listed(), in_place());
  EXPECT_EQ(listed().size(), 6U);
  // What it was made of is kept.
  EXPECT_EQ(build().traced, 0U);
  EXPECT_EQ(listed().size(), 12U);
}

TEST_F(OneNameTest, AFileThatCannotBeRemovedCostsNoManifest) {
  build();
  request.overrides = {"camera.count=2"};
  PickyDisk disk("3.png");
  const BuildResult result = build(disk);
  ASSERT_EQ(result.failures.size(), 2U);
  EXPECT_NE(result.failures[0].first.find("3.png"), std::string::npos);
  EXPECT_EQ(read_images_manifest(output()).size(), 4U);
  EXPECT_TRUE(build().ok());
  EXPECT_EQ(listed(), in_place());
}

TEST_F(OneNameTest, ADiskThatFailsEndsTheBuildThoughOthersAreToGoOn) {
  FaultyDisk disk(Fault::refuse, 4);  // within the first image
  const BuildResult result = build(disk, {.keep_going = true});
  EXPECT_TRUE(disk.reached());
  EXPECT_EQ(result.failed, 1U);
  EXPECT_EQ(result.not_reached, k_images - 1);
}

TEST_F(OneNameTest, ALicenceOfAnyEncodingIsRead) {
  write_file_atomic(recipe_folder() / "models/LICENSE", std::string_view("\xa9 M\xfcller\n"));
  write_file_atomic(recipe_folder() / "materials/COPYING", std::string_view("\xff\xfe\xa9\0", 4));
  fs::create_directories(recipe_folder() / "environments/LICENSE");
  EXPECT_TRUE(build().ok());
  std::map<std::string, std::string> texts;
  for (const LicenceRecord& licence : read_dataset_manifest(output()).licences)
    for (const std::string& asset : licence.assets)
      texts[asset] = licence.text;
  EXPECT_EQ(texts["models/box.off"], "\u00a9 M\u00fcller\n");
  EXPECT_EQ(texts["materials/red.mat"], "\u00a9");
  // One that is no text at all, in megabytes, is left out.
  write_file_atomic(recipe_folder() / "models/LICENSE", std::string(2U << 20U, '\xff'));
  EXPECT_TRUE(build().ok());
  for (const LicenceRecord& licence : read_dataset_manifest(output()).licences)
    EXPECT_FALSE(licence.assets.front().starts_with("models/")) << licence.assets.front();
}

std::string name_of(const testing::TestParamInfo<Fault>& info) {
  return info.param == Fault::refuse ? "Refuse" : info.param == Fault::crash ? "Crash" : "Tear";
}
INSTANTIATE_TEST_SUITE_P(Disk, BuildFaultsTest,
                         testing::Values(Fault::refuse, Fault::crash, Fault::tear), name_of);

}  // namespace
}  // namespace ds
