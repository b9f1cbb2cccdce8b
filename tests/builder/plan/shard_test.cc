// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/shard.h"

#include "manifests/manifest.h"
#include "tests/builder/tiny_dataset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t k_shards = 3;

TEST(Shard, IsReadAsNumberAndCount) {
  const auto read = [](std::string_view text) {
    const Shard shard = read_shard(text);
    return std::pair(shard.number, shard.count);
  };
  EXPECT_EQ(read("1/1"), std::pair(1U, 1U));
  EXPECT_EQ(read("2/4"), std::pair(2U, 4U));
  EXPECT_EQ(read("65536/65536"), std::pair(65536U, 65536U));
  EXPECT_EQ(read("03/10"), std::pair(3U, 10U)) << "as seq -w counts";
}

TEST(Shard, AnythingElseIsAUsageErrorThatSaysWhatWasFound) {
  for (const char* text : {"",
                           "/",
                           "1",
                           "a/b",
                           "0/4",
                           "5/4",
                           "1/0",
                           "0/0",
                           "-1/2",
                           "1/-2",
                           "+1/2",
                           "1/2x",
                           "x1/2",
                           "1 /2",
                           " 1/2",
                           "1/2/3",
                           "1/",
                           "/2",
                           "1.0/2",
                           "1/65537",
                           "1/4294967297",
                           "1/99999999999999999999"}) {
    try {
      read_shard(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_EQ(error.what(), fmt::format("--shard: wanted I/N with 1 <= I <= N <= 65536, such as "
                                          "2/4, got {}",
                                          text));
    }
  }
}

TEST(Shard, SharesAreDisjointCoverAllAndAreAboutEven) {
  for (const std::uint32_t count : {1U, 2U, 3U, 4U, 7U, 16U}) {
    std::vector<int> sizes(count, 0);
    constexpr int k_models = 500, k_views = 14;
    for (int image = 0; image < k_models * k_views; ++image) {
      const std::string id = fmt::format("m{}.off/{}", image / k_views, image % k_views);
      int holders = 0;
      for (std::uint32_t number = 1; number <= count; ++number) {
        if (!Shard{number, count}.holds(id)) continue;
        ++holders;
        ++sizes[number - 1];
      }
      ASSERT_EQ(holders, 1) << id;
    }
    // The sizes are those of chance: 4 standard deviations of the binomial distribution.
    const double mean = k_models * k_views / static_cast<double>(count);
    for (const int size : sizes)
      EXPECT_NEAR(size, mean, 4 * std::sqrt(mean)) << count;
  }
}

TEST(Shard, AnImageStaysInItsShare) {
  // Builds of two versions of dsbuild are to agree.
  EXPECT_TRUE((Shard{4, 4}).holds("human.ply/0"));
  EXPECT_TRUE((Shard{2, 3}).holds("human.ply/0"));
}

class ShardBuildTest : public TinyDataset {
 protected:
  BuildResult build_shard(std::uint32_t number, const BuildOptions& options = {}) {
    shard = {number, k_shards};
    BuildResult result = build(options);
    shard = {};
    return result;
  }
  /// Ids of the images of a shard.
  std::set<std::string> share(std::uint32_t number) {
    std::set<std::string> ids;
    for (const PlannedImage& image : plan().images)
      if (Shard{number, k_shards}.holds(image.spec.id)) ids.insert(image.spec.id);
    return ids;
  }
  std::set<std::string> listed() const {
    std::set<std::string> ids;
    for (const ImageRecord& record : read_images_manifest(output()))
      ids.insert(record.id);
    return ids;
  }
};

TEST_F(ShardBuildTest, InAnyOrderMakeTheBytesOfOneBuild) {
  build();
  const auto wanted = contents();
  for (const std::vector<std::uint32_t>& order :
       {std::vector<std::uint32_t>{1, 2, 3}, {3, 1, 2}, {2, 2, 3, 1}}) {
    fs::remove_all(output());
    std::set<std::string> done;
    for (const std::uint32_t number : order) {
      const std::set<std::string> mine = share(number);
      const BuildResult result = build_shard(number);
      EXPECT_TRUE(result.ok());
      EXPECT_EQ(result.images, mine.size());
      EXPECT_EQ(result.built + result.reused, mine.size());
      EXPECT_EQ(std::set(calls.traced.begin(), calls.traced.end()),
                done.contains(*mine.begin()) ? std::set<std::string>{} : mine);
      done.insert(mine.begin(), mine.end());
      EXPECT_EQ(listed(), done);
    }
    EXPECT_EQ(contents(), wanted);
    const BuildResult after = build();
    EXPECT_EQ(after.built, 0U);
    EXPECT_EQ(after.reused, k_images);
    EXPECT_EQ(contents(), wanted);
  }
}

TEST_F(ShardBuildTest, AddingAModelMovesNoImageOfAnother) {
  std::vector<std::set<std::string>> before;
  for (std::uint32_t number = 1; number <= k_shards; ++number)
    before.push_back(share(number));
  fs::copy_file(recipe_folder() / "models/box.off", recipe_folder() / "models/a-box.off");
  for (std::uint32_t number = 1; number <= k_shards; ++number) {
    const std::set<std::string> after = share(number);
    EXPECT_TRUE(std::includes(after.begin(), after.end(), before[number - 1].begin(),
                              before[number - 1].end()));
  }
}

TEST_F(ShardBuildTest, ForceTracesTheShareOnly) {
  build();
  const auto wanted = contents();
  const BuildResult result = build_shard(2, {.force = true});
  EXPECT_EQ(result.traced, share(2).size());
  EXPECT_EQ(result.images, share(2).size());
  EXPECT_EQ(contents(), wanted);
}

TEST_F(ShardBuildTest, RemovesOnlyFilesOfItsOwnImages) {
  build();
  fs::remove(recipe_folder() / "models/box.off");
  const auto box_files = [&] {
    std::set<std::string> ids;
    for (const auto& [path, text] : contents())
      if (path.starts_with("images/box.off/") && path.ends_with(".mask.png"))
        ids.insert(fmt::format("box.off/{}", path[sizeof("images/box.off/") - 1]));
    return ids;
  };
  for (std::uint32_t number = 1; number <= k_shards; ++number) {
    const std::set<std::string> before = box_files();
    const BuildResult result = build_shard(number);
    EXPECT_EQ(result.images, result.reused);
    EXPECT_EQ(listed().size(), k_images / 2) << "the other model's";
    for (const std::string& id : before)
      EXPECT_EQ(box_files().contains(id), !(Shard{number, k_shards}.holds(id))) << id;
  }
  EXPECT_FALSE(fs::exists(output() / "images/box.off"));
}

TEST_F(ShardBuildTest, AFileLostFromAnotherShareIsNeitherListedNorMade) {
  build();
  const auto wanted = contents();
  const std::string lost = *share(1).begin();
  fs::remove(output() / "images" / (lost + ".png"));
  EXPECT_EQ(build_shard(2).built, 0U);
  EXPECT_EQ(listed().size(), k_images - 1);
  EXPECT_FALSE(listed().contains(lost));
  EXPECT_EQ(build_shard(1).built, 1U);
  EXPECT_EQ(contents(), wanted);
}

TEST_F(ShardBuildTest, AnotherSharesFailureIsNotItsOwn) {
  calls.fails_on = *share(1).begin();
  EXPECT_TRUE(build_shard(2).ok());
  EXPECT_EQ(build_shard(1).failed, 1U);
  EXPECT_TRUE(build_shard(3).ok());
  EXPECT_FALSE(listed().contains(calls.fails_on));
  write_file_atomic(recipe_folder() / "models/bad.ply",
                    std::string_view("ply\nformat ascii 1.0\n"));
  std::uint64_t failed = 0;
  for (std::uint32_t number = 1; number <= k_shards; ++number)
    failed += build_shard(number, {.keep_going = true}).failed;
  EXPECT_EQ(failed, 4U + 1U) << "each is of one share";
}

TEST_F(ShardBuildTest, AStoppedBuildListsWhatOthersPutInPlace) {
  std::uint32_t large = 1;
  for (std::uint32_t number = 2; number <= k_shards; ++number)
    if (share(number).size() > share(large).size()) large = number;
  for (std::uint32_t number = 1; number <= k_shards; ++number)
    if (number != large) build_shard(number);
  calls.stop_after_one = &stop;
  EXPECT_TRUE(build_shard(large).stopped);
  EXPECT_EQ(listed().size(), k_images - share(large).size() + 1);
}

TEST_F(ShardBuildTest, APictureOverTheLimitIsListedByNoShare) {
  const std::string refused = *share(1).begin();
  calls.rejected[refused] = 1;
  request.overrides = {"engine.rejected_limit=1"};
  build();
  EXPECT_TRUE(listed().contains(refused));
  request.overrides = {"engine.rejected_limit=0"};
  EXPECT_TRUE(build_shard(2).ok());
  EXPECT_FALSE(listed().contains(refused));
  EXPECT_EQ(listed().size(), k_images - 1);
}

}  // namespace
}  // namespace ds
