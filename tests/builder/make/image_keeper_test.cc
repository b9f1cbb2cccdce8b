// SPDX-License-Identifier: Apache-2.0
// Images that wait for the disk share its waits, and what one of them makes no other makes again.
#include "tests/builder/tiny_dataset.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// A disk so slow that all images are traced before the first is written.
class SlowDisk : public RealDisk {
 public:
  SlowDisk(const std::atomic<std::size_t>& films, std::size_t images)
      : films_(films), images_(images) {}
  std::size_t waits = 0, files = 0;

  void write_all(std::span<const FileToWrite> all) override {
    constexpr std::chrono::milliseconds k_step{20};
    for (int i = 0; i < 250 && waits == 0 && films_ < images_; ++i)
      std::this_thread::sleep_for(k_step);
    ++waits;
    files += all.size();
    RealDisk::write_all(all);
  }

 private:
  const std::atomic<std::size_t>& films_;
  std::size_t images_;
};

class ImageKeeperTest : public TinyDataset {};

TEST_F(ImageKeeperTest, ImagesThatWaitAreWrittenTogether) {
  build();
  const auto wanted = contents();
  fs::remove_all(output());
  calls.films = 0;
  SlowDisk disk(calls.films, k_images);
  const BuildResult result = build(disk);
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(result.built, k_images);
  EXPECT_EQ(contents(), wanted);
  EXPECT_LE(disk.waits, 3U) << "those traced before the first was taken, and the rest";
  EXPECT_GE(disk.files, 3 * k_images) << "a picture, a mask and a record of each";
}

TEST_F(ImageKeeperTest, AMaskThatSeveralImagesShareIsTracedOnce) {
  request.overrides = {"materials.assign=all"};
  SlowDisk disk(calls.films, 2 * k_images);
  const BuildResult result = build(disk);
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(result.built, 2 * k_images);
  EXPECT_EQ(calls.traced.size(), 2 * k_images);
  EXPECT_EQ(calls.planes.size(), k_images) << "a mask does not depend on the material";
}

TEST_F(ImageKeeperTest, NothingIsUnderWayWhenABuildIsOver) {
  request.overrides = {"materials.assign=all"};
  build();
  const BuildResult again = build();
  EXPECT_EQ(again.reused, 2 * k_images);
  EXPECT_EQ(calls.traced.size() + calls.planes.size(), 0U);
}

}  // namespace
}  // namespace ds
