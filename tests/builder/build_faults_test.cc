// SPDX-License-Identifier: Apache-2.0
// The disk fails at every single operation of a build, one after the other; whatever is left, the
// next build makes the same bytes as one that nothing happened to.
#include "tests/builder/tiny_dataset.h"

#include <gtest/gtest.h>

#include <fstream>

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
      fail(ErrorKind::io, "{}: cannot write: no space left on device", file.string());
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

std::string name_of(const testing::TestParamInfo<Fault>& info) {
  return info.param == Fault::refuse ? "Refuse" : info.param == Fault::crash ? "Crash" : "Tear";
}
INSTANTIATE_TEST_SUITE_P(Disk, BuildFaultsTest,
                         testing::Values(Fault::refuse, Fault::crash, Fault::tear), name_of);

}  // namespace
}  // namespace ds
